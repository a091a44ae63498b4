/* options.c - the options of `lacquer pca` that name axes of the table. */
#include "program/pca/pca.h"

#include <string.h>

#include "pca/options_text.h"
#include "program/message.h"
#include "program/options.h"
#include "system/status.h"

static bool find_channel(const pca_request *request, const lq_table *table, int *channel) {
    char list[LQ_MESSAGE_SIZE] = "";
    *channel = 0;
    if (!request->channel) return true;
    for (; *channel < table->channel_count; ++*channel) {
        if (strcmp(table->channel_names[*channel], request->channel) == 0) return true;
        lq_list_add(list, sizeof list, table->channel_names[*channel]);
    }
    cli_message("--channel: unknown channel '%s'; the table has: %s", request->channel, list);
    return false;
}

/* What the option came to; false: a line was printed. */
static bool fine(const char *option, lq_status status, const lq_error *error) {
    if (status != LQ_OK) cli_message("%s: %s", option, error->text);
    return status == LQ_OK;
}

bool pca_resolve(pca_request *request, const lq_table *table, int *channel) {
    lq_pca_options *o = &request->options;
    const lq_axis *axes = table->axes;
    const int count = table->axis_count;
    lq_error why = {""};
    o->value_axis = lq_table_axis(table, "tau");
    for (size_t i = 0; i < request->texels.count; i++)
        if (!fine("--texels", lq_pca_read_texels(o, request->texels.text[i], axes, count, &why), &why))
            return false;
    const char *separate = request->separate, *split = request->split, *bases = request->bases;
    return (!separate || fine("--separate", lq_pca_read_separations(o, separate, axes, count, &why), &why)) &&
           (!split || fine("--split", lq_pca_read_split(o, split, axes, count, &why), &why)) &&
           (!bases || fine("--bases", lq_pca_read_bases(o, bases, &why), &why)) &&
           find_channel(request, table, channel);
}
