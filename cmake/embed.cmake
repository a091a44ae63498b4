# Script: turns a text file into a C array, so that sources in other languages stay files of their own.
#     cmake -DFROM=page.js -DTO=page_js.c -DNAME=lq_page_script -P embed.cmake
file(READ "${FROM}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE "${TO}" "extern const char ${NAME}[];\nconst char ${NAME}[] = {${bytes}0};\n")
