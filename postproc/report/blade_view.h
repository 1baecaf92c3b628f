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

/* True if the field has elements and shapes, of as many modes as the response. Of a disc the field
 * must match the response (post_blade_field_match). */
bool post_blade_view_fits(const post_blade_view *view, const mhb_response *response);

/* Numbers for the script, at most 3 MB as text:
 *
 *   nodes, triangles  numbers;  lo, size  [3] box of the surface, m;  modesLeftOut
 *   position  [nodes][3] uint16 in the box
 *   index     [triangles][3] uint16, or uint32 from 65536 nodes
 *   modes     [{f Hz, d, s, data}]: int8 [nodes][9], displacement x d kg^-1/2 and Cauchy stress
 *             xx, yy, zz, xy, yz, xz times s Pa kg^-1/2, in 1/127. Of a disc: row of them for each
 *             of the nodal diameters in waves, w its place there; im: imaginary part as data, where
 *             the shape is complex
 *   points    [{b, x, a, order, lag, k, q}]: branch, abscissa and amplitude of the point; lag rad,
 *             of the right neighbour at the fundamental; harmonics kept; q: float32
 *             [k][row][re, im] m kg^1/2. Of a disc: w place in waves, or -1; back 1: the conjugate
 *             shapes
 *   axis [3], blades, lag (the same of a mode without a disc)
 *
 * Where the surface has too many nodes, those of a cell of a grid are merged. Errors: SHB_ERR_IO no
 * memory. */
shb_status post_blade_data(const post_analysis *analysis, const post_blade_view *view,
                           post_buffer *out);

#endif
