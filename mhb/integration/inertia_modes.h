/* Residual inertia as modes: R + w^2 R2 of the balance becomes a structure that can be integrated.
 *
 * u = R p - R2 p'' has no solution forward in time. With R = L L^T and L^-1 R2 L^-T = V
 * diag(1/nu_i^2) V^T the modes psi_i = nu_i L v_i of frequency nu_i have
 *   sum psi_i psi_i^T/(nu_i^2 - w^2) = R + w^2 R2 + O(w^4/nu^4).
 * They are the fewest modes with this R and R2. Their error is as large as that of R + w^2 R2.
 *
 * If the model has the coefficient R3 of w^4 too: R2 = L L^T, L^-1 R3 L^-T = V diag(1/nu_i^2) V^T,
 * psi_i = nu_i^2 L v_i. These modes have the same R2 and R3, with an error O(w^6). R - sum psi
 * psi^T/nu^2 = R - R2 R3^-1 R2 remains as flexibility. It is not negative, because [R R2; R2 R3] =
 * sum (a x phi)(a x phi)^T/w^2, a = (1, 1/w^2), over the modes left out.
 *
 * Many contact dofs have as many directions. Those with little inertia hold rounding alone. The
 * MHB_INERTIA_MODES directions of most flexibility (with R3: of most inertia) have modes. The
 * others keep their flexibility. On the face of 22 pairs of cases/z_notch_blade the receptance then
 * differs by 2e-6 of the flexibility at 1 kHz.
 *
 * The residual terms of load and probes stay. The response to the load is steady, at known
 * frequencies. The probes follow from the harmonics of the forces; the new modes are zero there.
 * Residual modes of the file (modal/model/residual_series.h) are not integrated: they are more, and
 * their frequencies far higher. */
#ifndef MHB_INTEGRATION_INERTIA_MODES_H
#define MHB_INTEGRATION_INERTIA_MODES_H

#include "modal/model/model.h"

/* Most modes. */
enum { MHB_INERTIA_MODES = 24 };

/* out <- the model with residual modes in place of residual inertia and of its part of the residual
 * flexibility. Their damping ratio is that of the last mode. Unchanged arrays are shared with the
 * model, which must outlive out.
 * Errors: SHB_ERR_INPUT no residual flexibility, or not finite. */
shb_status mhb_inertia_modes(const modal_model *model, modal_model *out);
void       mhb_inertia_free(modal_model *out);

#endif
