/* beside.h - files that belong to the program, found from where it is: built or installed. */
#ifndef LACQUER_PROGRAM_BESIDE_H
#define LACQUER_PROGRAM_BESIDE_H

#include <stdbool.h>
#include <stddef.h>

/* The first of `places`, each after the program's own folder ("/../share/lacquer"), that `mode` of access(2)
 * allows.
 */
bool cli_beside(const char *const *places, size_t count, int mode, char *path, size_t size);

#endif
