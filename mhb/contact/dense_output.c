#include "mhb/contact/dense_output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/constants.h"

enum { POINTS = 1 + MHB_NODES };

shb_status mhb_dense_output_create(const mhb_collocation *rule, mhb_dense_output *output) {
  *output       = (mhb_dense_output){0};
  output->piece = calloc(MHB_MAX_PIECES, sizeof *output->piece);
  SHB_CHECK(output->piece, SHB_ERR_IO, "out of memory");
  for (int i = 0; i < MHB_NODES; i++) output->node[1 + i] = rule->node[i];
  for (int i = 0; i < POINTS; i++) {
    double product = 1;
    for (int j = 0; j < POINTS; j++)
      if (j != i) product *= output->node[i] - output->node[j];
    output->weight[i] = 1 / product;
  }
  return SHB_OK;
}

void mhb_dense_output_destroy(mhb_dense_output *output) {
  free(output->piece);
  *output = (mhb_dense_output){0};
}

static mhb_dense_piece *add(mhb_dense_output *output, mhb_state state, double t0) {
  if (!output->enabled) return NULL;
  if (output->n == MHB_MAX_PIECES) {
    output->full = 1;
    return NULL;
  }
  mhb_dense_piece *piece = &output->piece[output->n++];
  piece->state           = state;
  piece->t0              = t0;
  return piece;
}

void mhb_dense_output_stick(mhb_dense_output *output, double t0, const double z[2]) {
  mhb_dense_piece *piece = add(output, MHB_STICK, t0);
  if (piece) memcpy(piece->z, z, sizeof piece->z);
}

void mhb_dense_output_slip(mhb_dense_output *output, const mhb_panel *panel) {
  mhb_dense_piece *piece = panel->h > 0 ? add(output, MHB_SLIDE, panel->t0) : NULL;
  if (!piece) return;
  piece->h        = panel->h;
  piece->theta[0] = panel->theta0;
  lanes_store(piece->theta + 1, panel->theta);
}

void mhb_dense_output_open(mhb_dense_output *output, double t0) {
  add(output, MHB_SEPARATE, t0);
}

void mhb_dense_output_frictionless(mhb_dense_output *output, double t0) {
  mhb_dense_piece *piece = add(output, MHB_SLIDE, t0);
  if (!piece) return;
  piece->h = SHB_TWO_PI; /* any direction: mu = 0 */
  memset(piece->theta, 0, sizeof piece->theta);
}

/* The collocation polynomial at fraction s of the panel, by the barycentric formula. */
static double direction_at(const mhb_dense_output *output, const mhb_dense_piece *piece, double s) {
  double sum = 0, total = 0;
  for (int i = 0; i < POINTS; i++) {
    double distance = s - output->node[i];
    if (distance == 0) return piece->theta[i];
    double weight = output->weight[i] / distance;
    sum += weight * (piece->theta[i] - piece->theta[0]);
    total += weight;
  }
  return piece->theta[0] + sum / total;
}

/* The last piece that has begun at t. Whole periods are added to t until the first piece has begun.
 * The lap of a contact that opens begins at a closing, which may be one period on. */
static const mhb_dense_piece *find(const mhb_dense_output *output, double *t) {
  while (*t < output->piece[0].t0) *t += SHB_TWO_PI;
  int low = 0, high = output->n;
  while (high - low > 1) {
    int middle = low + (high - low) / 2;
    if (output->piece[middle].t0 <= *t) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return &output->piece[low];
}

mhb_state mhb_dense_output_at(const mhb_dense_output *output, double t, double force[3]) {
  force[0] = force[1] = force[2] = 0;
  if (output->n == 0) return MHB_SEPARATE;
  double                 y[3], dy[3];
  const mhb_dense_piece *piece = find(output, &t);
  if (piece->state == MHB_SEPARATE) return MHB_SEPARATE;
  mhb_signals_at(output->signals, t, y, dy, NULL);
  force[0] = fmax(0, y[0]);
  if (piece->state == MHB_STICK) {
    for (int k = 0; k < 2; k++) force[1 + k] = y[1 + k] - piece->z[k];
  } else {
    double s     = fmin(1, (t - piece->t0) / piece->h);
    double theta = direction_at(output, piece, s), limit = output->mu * force[0];
    force[1] = limit * cos(theta);
    force[2] = limit * sin(theta);
  }
  return piece->state;
}
