/* One step of all modes, written once for vectors of WIDTH numbers and included for each.
 *
 *   z(t + h) = trace z(t) - det z(t - h) - sum of rows times forces, for every mode and blade
 *   right, left = sums of rows times z(t + h);  output likewise, if asked for
 * No include guard: ring_step.c defines WIDTH, TARGET and NAME(x) and includes it for each
 * instruction set. Vectors wider than the set are slow with GCC 12. Plain loops would keep the sums
 * in memory. */

typedef double NAME(vector) __attribute__((vector_size(8 * WIDTH)));
typedef double NAME(loose) __attribute__((vector_size(8 * WIDTH), aligned(8)));
#define INSIDE static inline __attribute__((always_inline, target(TARGET)))

INSIDE NAME(vector) NAME(load)(const double *x) {
  return *(const NAME(loose) *)x;
}

INSIDE void NAME(store)(double *x, NAME(vector) y) {
  *(NAME(loose) *)x = y;
}

/* Numbers of a mistuned ring's first mode, of the lanes at a place. */
INSIDE const double *NAME(own_of)(const mhb_ring_modes *a, size_t at) {
  size_t lane = at - MHB_LANES;
  return a->own + lane / MHB_LANES * (size_t)a->modes * MHB_RING_LANE_SIZE * MHB_LANES +
         lane % MHB_LANES;
}

/* z(t + h) of a mode without kicks, each lane with its own coefficients. */
INSIDE NAME(vector) NAME(free_step)(const mhb_ring_modes *a, const double *own, const double *z) {
  return NAME(load)(own + MHB_RING_TRACE * MHB_LANES) * NAME(load)(z + a->newest) -
         NAME(load)(own + MHB_RING_DET * MHB_LANES) * NAME(load)(z + a->oldest);
}

/* One pair. The rows of a mode and the sums stay in registers, the forces in memory. */
INSIDE void NAME(one_pair)(const mhb_ring_modes *a, size_t at, size_t block, bool sampled,
                           bool mistuned) {
  const double *c = a->coefficient, *p = a->p + at, *own = mistuned ? NAME(own_of)(a, at) : NULL;
  double       *z = a->z + block;
  NAME(vector) right[3], left[3], out[3];
  NAME(vector) behind[3]; /* forces of the left neighbour; loads across two cache lines */
  for (int i = 0; i < 3; i++) {
    right[i] = left[i] = out[i] = (NAME(vector)){0};
    behind[i]                   = NAME(load)(p + (size_t)i * a->row - a->copies);
  }
  for (int k = 0; k < a->modes; k++, c += a->stride, z += 2 * MHB_LANES) {
    NAME(vector) row[6], next;
    for (int i = 0; i < 6; i++) row[i] = c[MHB_RING_ROWS + i] - (NAME(vector)){0};
    if (mistuned) {
      NAME(vector) kick = {0}, other = {0};
      for (int i = 0; i < 3; i++) {
        kick += row[i] * NAME(load)(p + (size_t)i * a->row);
        other += row[3 + i] * behind[i];
      }
      next =
          NAME(free_step)(a, own, z) - NAME(load)(own + MHB_RING_GAIN * MHB_LANES) * (kick + other);
      own += MHB_RING_LANE_SIZE * MHB_LANES;
    } else {
      NAME(vector) kept = c[MHB_RING_TRACE] * NAME(load)(z + a->newest);
      NAME(vector) lost = c[MHB_RING_DET] * NAME(load)(z + a->oldest);
      for (int i = 0; i < 3; i++) {
        kept -= row[i] * NAME(load)(p + (size_t)i * a->row);
        lost += row[3 + i] * behind[i];
      }
      next = kept - lost;
    }
    NAME(store)(z + a->oldest, next);
    for (int i = 0; i < 3; i++) {
      right[i] += row[i] * next;
      left[i] += row[3 + i] * next;
    }
    for (int i = 0; i < 3 && sampled; i++) out[i] += c[MHB_RING_ROWS + 6 + i] * next;
  }
  for (int i = 0; i < 3; i++) {
    NAME(store)(a->right + (size_t)i * a->row + at, right[i]);
    NAME(store)(a->left + (size_t)i * a->row + at, left[i]);
    if (sampled) NAME(store)(a->out + (size_t)i * a->lanes + at - MHB_LANES, out[i]);
  }
}

/* Rows of one pair, or of the output, times the modes. */
INSIDE void NAME(sum_rows)(const mhb_ring_modes *a, const double *c, const double *z, double *to,
                           size_t row) {
  NAME(vector) sum[3];
  for (int i = 0; i < 3; i++) sum[i] = (NAME(vector)){0};
  for (int k = 0; k < a->modes; k++, c += a->stride, z += 2 * MHB_LANES) {
    NAME(vector) now = NAME(load)(z);
    for (int i = 0; i < 3; i++) sum[i] += c[i] * now;
  }
  for (int i = 0; i < 3; i++) NAME(store)(to + (size_t)i * row, sum[i]);
}

/* Any number of pairs, one after the other. */
INSIDE void NAME(many_pairs)(const mhb_ring_modes *a, size_t at, size_t block, bool sampled) {
  double       *z = a->z + block, *old = z + a->oldest;
  const double *own = a->own ? NAME(own_of)(a, at) : NULL;
  for (int k = 0; k < a->modes; k++) {
    const double *c = a->coefficient + (size_t)k * a->stride;
    double       *x = z + (size_t)k * 2 * MHB_LANES;
    if (own) {
      NAME(store)
      (x + a->oldest, NAME(free_step)(a, own + (size_t)k * MHB_RING_LANE_SIZE * MHB_LANES, x));
      continue;
    }
    NAME(store)
    (x + a->oldest,
     c[MHB_RING_TRACE] * NAME(load)(x + a->newest) - c[MHB_RING_DET] * NAME(load)(x + a->oldest));
  }
  for (int j = 0; j < a->pairs; j++) {
    const double *force = a->p + (size_t)(3 * j) * a->row + at;
    NAME(vector) p[3], q[3];
    for (int i = 0; i < 3; i++) {
      p[i] = NAME(load)(force + (size_t)i * a->row);
      q[i] = NAME(load)(force + (size_t)i * a->row - a->copies);
    }
    for (int k = 0; k < a->modes; k++) {
      const double *r   = a->coefficient + (size_t)k * a->stride + MHB_RING_ROWS + 6 * j;
      double       *x   = old + (size_t)k * 2 * MHB_LANES;
      NAME(vector) kick = r[0] * p[0] + r[1] * p[1] + r[2] * p[2];
      kick              = kick + r[3] * q[0] + r[4] * q[1] + r[5] * q[2];
      if (own)
        kick *= NAME(load)(own + ((size_t)k * MHB_RING_LANE_SIZE + MHB_RING_GAIN) * MHB_LANES);
      NAME(store)(x, NAME(load)(x) - kick);
    }
  }
  for (int j = 0; j < a->pairs; j++) {
    const double *r  = a->coefficient + MHB_RING_ROWS + 6 * j;
    size_t        to = (size_t)(3 * j) * a->row + at;
    NAME(sum_rows)(a, r, old, a->right + to, a->row);
    NAME(sum_rows)(a, r + 3, old, a->left + to, a->row);
  }
  if (sampled) NAME(sum_rows)
  (a, a->coefficient + MHB_RING_ROWS + 6 * a->pairs, old, a->out + at - MHB_LANES, a->lanes);
}

static __attribute__((target(TARGET))) void NAME(step_modes)(const mhb_ring_modes *a) {
  for (size_t lane = 0; lane < a->lanes; lane += WIDTH) {
    size_t at    = MHB_LANES + lane;
    size_t block = lane / MHB_LANES * (size_t)a->modes * 2 * MHB_LANES + lane % MHB_LANES;
    if (a->pairs > 1)
      NAME(many_pairs)(a, at, block, a->out);
    else if (a->own)
      NAME(one_pair)(a, at, block, a->out, true);
    else if (a->out)
      NAME(one_pair)(a, at, block, true, false);
    else
      NAME(one_pair)(a, at, block, false, false);
  }
}

#undef INSIDE
