# Writes the hash of a library into a C file: cmake -DLIBRARY=... -DTO=... -P build.cmake
file(SHA256 ${LIBRARY} hash)
string(SUBSTRING ${hash} 0 16 hash)
file(WRITE ${TO} "#include \"program/build.h\"\n\nconst char cli_build[] = \"${hash}\";\n")
