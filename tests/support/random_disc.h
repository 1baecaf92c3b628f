/* Modal models by nodal diameter for tests of identities. */
#ifndef TESTS_SUPPORT_RANDOM_DISC_H
#define TESTS_SUPPORT_RANDOM_DISC_H

#include "modal/model/nodal_diameters.h"

/* A random model (random_model.h) at each of the nodal diameters 0..N/2. Shapes, residual terms and
 * Coriolis terms, if asked for, are complex between 0 and N/2. */
void random_disc(int n_pairs, int blades, int parts, bool coriolis, unsigned long long seed,
                 modal_nodal_diameters *disc);

/* The same of a shroud face with n pairs to ground (bench/shroud_face.h). Nodal diameters differ in
 * modes, and in the flexibility for a few smooth motions of the face.
 *   coriolis  in  rad/s, size of the Coriolis terms; 0: none */
void face_disc(const modal_model *face, int blades, double coriolis, modal_nodal_diameters *disc);

#endif
