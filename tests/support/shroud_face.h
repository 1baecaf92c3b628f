/* A blade whose shroud face touches ground in many patches: a model of any size for the
 * benchmark. */
#ifndef TESTS_SHROUD_FACE_H
#define TESTS_SHROUD_FACE_H

#include "mhb/problem/settings.h"
#include "modal/model/model.h"

/* The tip-contact beam (tests/support/three_degree.h) with its contact spread over n patches of
 * equal area, at y = -1 .. 1 across the face. The face moves as 0.3 + y^8 of the tip, and slightly
 * skewed: the edges slip and separate while most of it sticks. Each patch yields by itself, and by
 * a third of that to the force on its neighbour (residual flexibility and inertia). */
void shroud_face_model(int n_patches, double force, modal_model *model);

/* The same with positions of the patches, and a face that moves as 0.6 + 0.5 y + 0.3 y^2. The field
 * is smooth, so that patches may be joined. At least two patches. */
void smooth_face_model(int n_patches, double force, modal_model *model);

/* kv = ku = 2e5 N/m, mu .3, n0 400 N, for the interface. */
mhb_settings shroud_face_settings(int harmonics);

#endif
