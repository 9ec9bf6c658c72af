# rejoin_embed_viewer(TARGET FOLDER)
#   Bundles the page's viewer (esbuild, npm) and compiles it into TARGET; report/detail/page_files.hpp hands it out.
#   The network is used only if FOLDER/node_modules is missing or older than the lock file.

option(REJOIN_VIEWER "Build the viewer of rejoin report; needs node (18 or later) and npm" ON)

function(rejoin_embed_viewer target folder)
  if(NOT REJOIN_VIEWER)
    target_sources(${target} PRIVATE detail/no_page_files.cpp)
    return()
  endif()
  find_program(REJOIN_NODE NAMES node nodejs)
  find_program(REJOIN_NPM npm)
  if(NOT REJOIN_NODE OR NOT REJOIN_NPM)
    message(FATAL_ERROR "node or npm is missing; run scripts/setup, or configure with -DREJOIN_VIEWER=OFF to build without rejoin report")
  endif()
  set(installed ${folder}/node_modules/.package-lock.json)
  # Two builds of one source folder may run at once.
  add_custom_command(
    OUTPUT ${installed}
    COMMAND flock ${folder}/package-lock.json ${folder}/install
    DEPENDS ${folder}/package-lock.json ${folder}/install
    WORKING_DIRECTORY ${folder}
    COMMENT "Installing the viewer's packages"
    VERBATIM)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/page_files.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${REJOIN_NODE} ${folder}/build.mjs ${output} ${output}.d
    DEPENDS ${installed} ${folder}/build.mjs
    DEPFILE ${output}.d
    COMMENT "Bundling the viewer"
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # nobody lints half a megabyte of text
endfunction()
