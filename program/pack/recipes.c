/* recipes.c - a recipe by name: those that were installed, or stand in the source tree. */
#include "program/beside.h"
#include "program/message.h"
#include "program/pack/pack.h"
#include "system/status.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const places[] = {"/../share/lacquer/recipes", "/../../recipes"};

static int is_recipe(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0 && entry->d_name[0] != '.';
}

/* "dfg, realtime, scene" */
static void list_names(const char *folder, char *list, size_t size) {
    struct dirent **entries;
    const int count = scandir(folder, &entries, is_recipe, alphasort);
    for (int i = 0; i < count; i++) {
        entries[i]->d_name[strlen(entries[i]->d_name) - 5] = '\0';
        lq_list_add(list, size, entries[i]->d_name);
        free(entries[i]);
    }
    if (count >= 0) free(entries);
}

bool pack_find_recipe(pack_request *r) {
    char folder[PATH_MAX] = "", list[256] = "";
    const char *named = r->recipe_path;
    const bool name = !strchr(named, '/') && !strchr(named, '.');
    if (access(named, F_OK) == 0 || !name) return true; /* a file: its reader says what is wrong with it */
    const bool found = cli_beside(places, 2, R_OK | X_OK, folder, sizeof folder);
    const int length = snprintf(r->found, sizeof r->found, "%s/%s.json", folder, named);
    if (found && length < (int)sizeof r->found && access(r->found, R_OK) == 0) {
        r->recipe_path = r->found;
        return true;
    }
    if (found) list_names(folder, list, sizeof list);
    cli_message("no recipe '%s'; accepted: a JSON file%s%s", named,
                *list ? ", or one of those shipped: " : "", list);
    return false;
}
