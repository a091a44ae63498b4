/* verbs.c - the table of verbs: what `lacquer VERB` can be. */
#include "program/verb.h"

#include <string.h>

static const cli_verb *const verbs[] = {
    &cli_verb_list,     &cli_verb_eval, &cli_verb_stack, &cli_verb_precompute, &cli_verb_pca,   &cli_verb_fit,
    &cli_verb_validate, &cli_verb_pack, &cli_verb_info,  &cli_verb_view,       &cli_verb_bench,
};

const cli_verb *cli_verb_at(size_t i) {
    return i < sizeof verbs / sizeof *verbs ? verbs[i] : NULL;
}

const cli_verb *cli_verb_find(const char *name) {
    for (size_t i = 0; cli_verb_at(i); i++)
        if (strcmp(cli_verb_at(i)->name, name) == 0) return cli_verb_at(i);
    return NULL;
}
