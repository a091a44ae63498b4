/* crew_alone.c - lacquer is one process. */
#include "program/crew.h"

void cli_crew_begin(int *argc, char ***argv) {
    (void)argc, (void)argv;
}

int cli_crew_end(int code) {
    return code;
}
