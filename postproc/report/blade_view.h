/* The blade in motion on the page: its surface, shapes and stresses of its modes, and modal
 * amplitudes of the points that the response keeps. The page's script (blade.js) draws them with
 * WebGL; without it the still picture remains. */
#ifndef POSTPROC_REPORT_BLADE_VIEW_H
#define POSTPROC_REPORT_BLADE_VIEW_H

#include "mesh/base/axes.h"
#include "postproc/analysis/response_analysis.h"
#include "postproc/draw/text_buffer.h"
#include "postproc/field/blade_field.h"

typedef struct {
  const post_blade_field *field; /* with motion */
  mesh_axis               axis;
} post_blade_view;

/* True if the field has elements and shapes, of as many modes as the response. */
bool post_blade_view_fits(const post_blade_view *view, const mhb_response *response);

/* Section of the page: canvas, controls, still picture. */
void post_blade_section(const post_analysis *analysis, const post_blade_view *view,
                        post_buffer *out);

/* Numbers for the script, at most 3 MB as text:
 *
 *   nodes, triangles  numbers;  lo, size  [3] box of the surface, m;  modesLeftOut
 *   position  [nodes][3] uint16 in the box
 *   index     [triangles][3] uint16, or uint32 from 65536 nodes
 *   modes     [{f Hz, d, s, data}]: int8 [nodes][9], displacement x d kg^-1/2 and Cauchy stress
 *             xx, yy, zz, xy, yz, xz times s Pa kg^-1/2, in 1/127
 *   points    [{b, x, a, order, k, q}]: branch, abscissa and amplitude of the point, harmonics
 *             kept; q: float32 [k][mode][re, im] m kg^1/2
 *   axis [3], blades, lag (rad, of the right neighbour at the excitation's first harmonic)
 *
 * Where the surface has too many nodes, those of a cell of a grid are merged. Errors: SHB_ERR_IO no
 * memory. */
shb_status post_blade_data(const post_analysis *analysis, const post_blade_view *view,
                           post_buffer *out);

#endif
