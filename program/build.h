/* build.h - which build of the library this is. */
#ifndef LACQUER_PROGRAM_BUILD_H
#define LACQUER_PROGRAM_BUILD_H

/* A hash of the library's file: two builds may round differently, and their parts are not mixed. Made by
 * cmake/build.cmake. */
extern const char cli_build[];

#endif
