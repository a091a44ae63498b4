/* crew.c - keeps the crew that main has found. */
#include "program/crew.h"

static const lq_crew *crew_of_run;

const lq_crew *cli_crew(void) {
    return crew_of_run;
}

bool cli_leads(void) {
    return !crew_of_run || crew_of_run->rank == 0;
}

void cli_crew_set(const lq_crew *crew) {
    crew_of_run = crew;
}
