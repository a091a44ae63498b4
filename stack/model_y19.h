/* model_y19.h - the statistical model with anisotropic interfaces (Y19).
 *
 * B18's variances become 2 x 2 covariances in the projected disc: R diag(f(alpha_x), f(alpha_y)) R^T of an
 * interface whose x axis R turns, and s alpha on each axis for what it lets through. Eq. 38 and 47-51 are
 * linear in variances, so that they hold for each entry; a lobe is the GGX lobe whose axes and roughnesses
 * are those of its covariance. Energies are those of the roughness across the plane of incidence's facets,
 * alpha(phi)^2 = alpha_x^2 cos^2 phi + alpha_y^2 sin^2 phi, which isotropic tables know.
 */
#ifndef LACQUER_STACK_MODEL_Y19_H
#define LACQUER_STACK_MODEL_Y19_H

#include "stack/model.h"

typedef struct lq_turned_lobe {
    double energy, mean; /* as lq_model_lobe has them */
    double alpha_x, alpha_y;
    double angle; /* of its x axis from the plane of incidence, about the normal, in radians */
} lq_turned_lobe;

/* Of one cosine: lobes[channel * lobe count + k]. `azimuth`: of the light's travel from the x axis that
 * layers are turned from, in degrees. LQ_BAD_INPUT: what lq_model_check refuses, a Lambertian base, and a
 * roughness at the pole of f that is turned against another layer's. */
lq_status lq_model_y19(const lq_stack *stack, const lq_model_query *query, double azimuth,
                       lq_turned_lobe *lobes, lq_error *error);

#endif
