# Writes OUTPUT, a header with a hash of all sources on which the result of a pair depends: two builds of one version may differ in them.
# Leaves it alone where the hash is the same.
# Usage: cmake -D SOURCE_DIR=... -D OUTPUT=... -P MatcherSource.cmake
set(patterns ${SOURCE_DIR}/shaders/*)
foreach(module core mesh zbuffer anneal match batch)
  list(APPEND patterns ${SOURCE_DIR}/src/${module}/*.cpp ${SOURCE_DIR}/src/${module}/*.hpp)
endforeach()
file(GLOB_RECURSE files RELATIVE ${SOURCE_DIR} ${patterns})
list(SORT files)
foreach(file ${files})
  file(SHA256 ${SOURCE_DIR}/${file} hash)
  string(APPEND all "${file} ${hash}\n")
endforeach()
string(SHA256 MATCHER_SOURCE "${all}")
string(SUBSTRING ${MATCHER_SOURCE} 0 10 MATCHER_SOURCE)
configure_file(${SOURCE_DIR}/src/batch/matcher_source.hpp.in ${OUTPUT} @ONLY)
