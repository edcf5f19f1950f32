# Writes one C++ file with a file's bytes, so that the program needs no data folder: FUNCTION() gives them.
file(READ ${INPUT} digits HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${digits}")
file(WRITE ${OUTPUT} "#include <span>\nnamespace impinge {\nstd::span<const unsigned char> ${FUNCTION}() {\n  static const unsigned char bytes[] = {${bytes}};\n  return bytes;\n}\n}\n")
