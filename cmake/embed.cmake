cmake_minimum_required(VERSION 3.25)
# Files as a C++ source: cmake -D output=… -D "files=<name>=<path>;…" -P embed.cmake
# Each becomes a std::string_view of its bytes in the namespace seedframe::web (page/web_files.h).
# A name that is given several times is one text, its files behind each other.
set(source "// Made by cmake/embed.cmake.\n#include \"page/web_files.h\"\n\nnamespace seedframe::web {\n")
set(names "")
foreach(entry IN LISTS files)
  string(REGEX MATCH "^([^=]+)=(.+)$" matched "${entry}")
  set(name ${CMAKE_MATCH_1})
  file(READ ${CMAKE_MATCH_2} bytes HEX)
  if(NOT name IN_LIST names)
    list(APPEND names ${name})
  endif()
  string(APPEND bytes_of_${name} "${bytes}")
endforeach()
foreach(name IN LISTS names)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," array "${bytes_of_${name}}")
  string(APPEND source "namespace {\nconst unsigned char bytes_of_${name}[] = {${array}};\n}  // namespace\n"
                       "const std::string_view ${name}(reinterpret_cast<const char*>(bytes_of_${name}),\n"
                       "                               sizeof bytes_of_${name});\n")
endforeach()
string(APPEND source "}  // namespace seedframe::web\n")
file(WRITE ${output} "${source}")
