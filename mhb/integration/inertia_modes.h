/* Residual inertia as modes: what the balance takes for R + w^2 R2 becomes a structure that can be integrated in time.
 *
 * u = R p - R2 p'' has no solution forward in time. But with R = L L^T and L^-1 R2 L^-T = V diag(1/nu_i^2) V^T the
 * modes psi_i = nu_i L v_i of frequency nu_i have
 *   sum psi_i psi_i^T/(nu_i^2 - w^2) = R + w^2 R2 + O(w^4/nu^4):
 * the least number of modes that answer with the same R and R2, as far from R + w^2 R2 as that is from the modes left out.
 * Where the model has the coefficient R3 of w^4 too, R2 = L L^T, L^-1 R3 L^-T = V diag(1/nu_i^2) V^T and psi_i = nu_i^2 L v_i
 * have the same R2 and R3; R - sum psi psi^T/nu^2 = R - R2 R3^-1 R2 stays flexibility. It is not negative: as a sum over the
 * modes left out [R R2; R2 R3] = sum (a x phi)(a x phi)^T/w^2, a = (1, 1/w^2). What differs is O(w^6).
 * The three terms of the load and the probes stay: the steady response to the load is known at its frequencies, and the
 * probes are read from harmonics of the forces, which the new modes do not reach (their shape at the probes is zero). The file's own residual modes
 * (modal/model/residual_series.h), more of them and up to far higher frequencies, are not integrated. */
#ifndef MHB_INTEGRATION_INERTIA_MODES_H
#define MHB_INTEGRATION_INERTIA_MODES_H

#include "modal/model/model.h"

/* A model with residual modes instead of residual inertia, and of residual flexibility as far as inertia belongs to it.
 * They are damped like the last mode. Shares what it does not change with the model, which must outlive it.
 * Errors: SHB_ERR_INPUT no residual flexibility, not finite; SHB_ERR_IO no memory. */
shb_status mhb_inertia_modes(const modal_model *model, modal_model *out);
void       mhb_inertia_free(modal_model *out);

#endif
