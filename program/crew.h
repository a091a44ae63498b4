/* crew.h - the processes of this run: one of `lacquer`, or those that mpirun started of `lacquer-mpi`. */
#ifndef LACQUER_PROGRAM_CREW_H
#define LACQUER_PROGRAM_CREW_H

#include <stdbool.h>

#include "system/crew.h"

/* NULL: this process is alone. */
const lq_crew *cli_crew(void);
/* Does this process write what all have made? */
bool cli_leads(void);

/* For main: the crew that cli_crew gives. */
void cli_crew_set(const lq_crew *crew);

/* crew_alone.c in lacquer, crew_mpi.c in lacquer-mpi: before anything else, and with the exit code last; the
 * code to exit with. */
void cli_crew_begin(int *argc, char ***argv);
int cli_crew_end(int code);

#endif
