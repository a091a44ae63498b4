/* options_text.h - parts of lq_pca_options as text that names axes: the command line's, and that of recipes.
 */
#ifndef LACQUER_PCA_OPTIONS_TEXT_H
#define LACQUER_PCA_OPTIONS_TEXT_H

#include "lacquer.h"

/* Each adds to `options`; LQ_BAD_INPUT and what is accepted. */

/* "tau:2,alpha:4", "n+kappa:8": axes to take out, in this order, and bases. */
lq_status lq_pca_read_separations(lq_pca_options *options, const char *text, const lq_axis *axes,
                                  int axis_count, lq_error *error);
/* "eta=1" or "eta=1,1.5" */
lq_status lq_pca_read_split(lq_pca_options *options, const char *text, const lq_axis *axes, int axis_count,
                            lq_error *error);
/* "mu=64", "mu=64:sqrt", and several after commas. */
lq_status lq_pca_read_texels(lq_pca_options *options, const char *text, const lq_axis *axes, int axis_count,
                             lq_error *error);
/* "4" or "4,8" */
lq_status lq_pca_read_bases(lq_pca_options *options, const char *text, lq_error *error);

#endif
