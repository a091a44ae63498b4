/* info_pack.h - `lacquer info DIR`: the functions of a pack, what they take, cost and are worth. */
#ifndef LACQUER_PROGRAM_INFO_PACK_H
#define LACQUER_PROGRAM_INFO_PACK_H

#include <stdbool.h>

/* The exit code of the verb. */
int info_pack(const char *folder, bool as_json);

#endif
