/* NAME.field.glb: the surface of the blade, or of all blades, moving; for any viewer of glTF. */
#ifndef POSTPROC_FIELD_FIELD_SCENE_H
#define POSTPROC_FIELD_FIELD_SCENE_H

#include "postproc/draw/text_buffer.h"
#include "postproc/field/whole_period.h"

enum { POST_SCENE_HARMONICS = 4 };

/* What was shown, for the terminal; also in asset.extras of the file. */
typedef struct {
  double scale;                          /* of the displacement in the picture */
  double greatest_displacement;          /* m, of any node from its mean */
  double greatest_stress;                /* Pa, at the dark end of the colours */
  int    n_harmonics;                    /* shown */
  int    harmonic[POST_SCENE_HARMONICS]; /* their k, ascending */
} post_scene_note;

/* Append a binary glTF 2.0 file. The surface has two morph targets a harmonic, Re U_k and -Im U_k;
 * their weights cos and sin are the animation. At most four harmonics are shown, the largest, and
 * none below 1e-3 of the largest. The mean stands in the positions. Colours tell the greatest von
 * Mises stress of the vibration with its mean over a period. A ring is one node a blade with
 * weights of its own. The node above turns the radial direction up.
 *   steps  in  keys of the animation in a period
 *   scale  in  of the displacement; 0: such that the greatest is 5 % of the blade's length
 * Errors: SHB_ERR_IO no memory; SHB_ERR_INPUT nothing moves. Source: glTF 2.0 (ISO/IEC 12113). */
shb_status post_field_scene(const post_period *period, int steps, bool ring, double scale,
                            post_scene_note *note, post_buffer *out);

#endif
