# Writes the text of INPUT, or the bytes of one that is no text, as a C++ string constant into OUTPUT (see pliant_embed).
if(INPUT MATCHES "[.]forest$")
  file(READ "${INPUT}" TEXT HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" TEXT "${TEXT}")
  set(BEGIN "\"")
  set(END "\"")
else()
  file(READ "${INPUT}" TEXT)
  set(BEGIN "R\"PLIANT(")
  set(END ")PLIANT\"")
endif()
string(REGEX REPLACE "[^A-Za-z0-9]" "_" SYMBOL "${RELATIVE}")
# A raw literal may not exceed 64 KiB in some compilers; adjacent literals join, so split the text.
string(LENGTH "${TEXT}" LENGTH)
set(PIECES "")
set(START 0)
while(START LESS LENGTH)
  string(SUBSTRING "${TEXT}" ${START} 8000 PIECE)
  string(APPEND PIECES "${BEGIN}${PIECE}${END}\n")
  math(EXPR START "${START} + 8000")
endwhile()
file(WRITE "${OUTPUT}" "// Made from ${RELATIVE}; do not edit.
#pragma once
#include <string_view>
namespace pliant::embedded {
inline constexpr char ${SYMBOL}_text[] = \"\"
${PIECES};
inline constexpr std::string_view ${SYMBOL}{${SYMBOL}_text, sizeof ${SYMBOL}_text - 1};
}
")
