# rejoin_embed_shaders(TARGET FILE...)
#   Compiles shader files into TARGET; zbuffer/gl/shaders.hpp hands them out by file name.  A changed shader rebuilds.
# Run as a script (cmake -P) it writes the source: -DOUTPUT=... -DFILES=a;b

if(CMAKE_SCRIPT_MODE_FILE)
  set(body "#include \"zbuffer/gl/shaders.hpp\"\n\nnamespace rejoin::zbuffer::gl {\n\n")
  string(APPEND body "std::string_view shader_source(std::string_view file) {\n")
  foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME)
    # Raw bytes as hex, so that no character of a shader (";" or "]" included) can upset CMake or the compiler.
    file(READ ${file} bytes HEX)
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
    string(REPLACE "'\\x0a'," "'\\x0a',\n      " bytes "${bytes}")   # a line a line
    string(APPEND body "  if (file == \"${name}\") {\n    static constexpr char kText[] = {\n      ${bytes}};\n")
    string(APPEND body "    return {kText, sizeof(kText)};\n  }\n")
  endforeach()
  string(APPEND body "  return {};\n}\n\n}  // namespace rejoin::zbuffer::gl\n")
  file(WRITE ${OUTPUT} "${body}")
  return()
endif()

set(REJOIN_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(rejoin_embed_shaders target)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/shaders.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DFILES=${ARGN}" -P ${REJOIN_EMBED_SCRIPT}
    DEPENDS ${ARGN} ${REJOIN_EMBED_SCRIPT}
    COMMENT "Embedding shaders"
    VERBATIM)
  # The custom command is known in this folder only, so a library of this folder owns the file.
  add_library(${target}_shaders OBJECT ${output})
  target_include_directories(${target}_shaders PRIVATE ${CMAKE_SOURCE_DIR}/src)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_shaders>)
endfunction()
