/* pack.c - a function of a pack as the source of `lacquer eval`. */
#include "program/eval/eval.h"

lq_status eval_source_pack(eval_source *source, const char *folder, const char *name, lq_error *error) {
    *source = (eval_source){.path = folder};
    lq_status status = lq_pack_open(&source->pack, folder, error);
    if (status == LQ_OK) status = lq_pack_find(source->pack, name, &source->function, error);
    if (status != LQ_OK) return status;
    const lq_pack_function *f = lq_pack_function_at(source->pack, source->function);
    source->axis_count = f->axis_count;
    for (int a = 0; a < f->axis_count; a++)
        source->axes[a] = (eval_axis){f->axes[a].name, f->axes[a].min, f->axes[a].max};
    source->channel_count = f->value_count;
    for (int c = 0; c < f->value_count; c++) source->channels[c] = f->values[c];
    return LQ_OK;
}
