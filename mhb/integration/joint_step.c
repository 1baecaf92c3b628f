#include "mhb/integration/joint_step.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"
#include "mhb/numerics/simd.h"

enum { S = MHB_STAGES, F = MHB_STAGE_FORCES, MAX_SWEEPS = 200 };

/* Relative to the force scale. Forces are solved if none changes by more than SOLVED in a sweep. A
 * contact is not followed again if its motion would change a stuck force by less than UNSEEN. */
static const double SOLVED = 1e-11, UNSEEN = 1e-12;

/* ---- motion of a contact ---- */

/* Rows of a contact on a side of its blade. */
static const double *rows_of(const mhb_joint_step *o, int side, int pair) {
  return o->ring->shape + (size_t)(side * 3 * o->ring->s.pairs + 3 * pair) * o->ring->s.modes;
}

static double *motion_of(const mhb_joint_step *o, int sector, int side) {
  int blade = (sector + side) % o->ring->s.blades;
  return o->motion + (size_t)(blade * S) * (size_t)o->ring->s.modes;
}

/* w[9] += what the modes of a blade add at the stages. */
MHB_HOT static void add_modes(int m, const double *row, const double *motion, double *w) {
  for (int k = 0; k < F; k++) {
    const double *r = row + k % 3 * m, *q = motion + k / 3 * m;
    double        sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < m; i++) sum += r[i] * q[i];
    w[k] += sum;
  }
}

/* w[9] -= R p of the contacts of a sector. p: [stage][3 contacts], its columns of the sector. */
MHB_HOT static void subtract_flexible(int n3, size_t contacts3, const double *R, const double *p,
                                      double *w) {
  for (int k = 0; k < F; k++) {
    const double *r = R + k % 3 * n3, *x = p + (size_t)(k / 3) * contacts3;
    double        sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n3; i++) sum += r[i] * x[i];
    w[k] -= sum;
  }
}

/* w[9] <- motion of a contact at the stages without its own flexibility. */
static void set_motion(const mhb_joint_step *o, int contact, const double *y, double *w) {
  const mhb_modal_structure *s = &o->ring->s;
  int    n3 = 3 * s->pairs, sector = contact / s->pairs, pair = contact % s->pairs;
  size_t all3 = 3 * (size_t)s->contacts;
  memcpy(w, y, sizeof *w * F);
  for (int side = 0; side < s->sides; side++)
    add_modes(s->modes, rows_of(o, side, pair), motion_of(o, sector, side), w);
  if (!s->flexibility) return;
  for (int neighbour = 0; neighbour < o->ring->n_neighbours; neighbour++)
    subtract_flexible(n3, all3, o->R + (size_t)(neighbour * n3 + 3 * pair) * (size_t)n3,
                      o->force + mhb_ring_step_sector(o->ring, sector, neighbour) * n3, w);
  for (int k = 0; k < F; k++)
    for (int c = 0; c < 3; c++)
      w[k] += o->spring[pair].R[k % 3][c] * o->force[(size_t)(k / 3) * all3 + 3 * contact + c];
}

/* motion -= W B^T change, the change of a contact's forces [stage][axis]. */
MHB_HOT static void move_modes(int m, const double *row, const double *response,
                               const double *change, double *motion) {
  for (int j = 0; j < S; j++) {
    double x = change[3 * j], y = change[3 * j + 1], z = change[3 * j + 2];
    for (int i = 0; i < m; i++) {
      double f = row[i] * x + row[m + i] * y + row[2 * m + i] * z;
      for (int k = 0; k < S; k++) motion[k * m + i] -= response[(k * S + j) * m + i] * f;
    }
  }
}

/* ---- all contacts ---- */

/* Forces [stage][axis] of a contact into those of all. Returns their largest change, N. */
static double put_forces(mhb_joint_step *o, int contact, const double *p) {
  const mhb_modal_structure *s = &o->ring->s;
  double                     change[F], worst = 0;
  for (int k = 0; k < F; k++) {
    double *at = o->force + (size_t)(k / 3) * 3 * (size_t)s->contacts + 3 * contact + k % 3;
    change[k]  = p[k] - *at;
    worst      = fmax(worst, fabs(change[k]));
    *at        = p[k];
  }
  for (int side = 0; side < s->sides && worst > 0; side++)
    move_modes(s->modes, rows_of(o, side, contact % s->pairs), o->response, change,
               motion_of(o, contact / s->pairs, side));
  return worst;
}

/* Whether a motion differs from that at which the contact was followed last. */
static int is_seen(const mhb_joint_step *o, int contact, const double *w, double scale) {
  const mhb_law *law  = &o->spring[contact % o->ring->s.pairs].law;
  double         most = 0;
  for (int k = 0; k < F; k++) most = fmax(most, fabs(w[k] - o->seen[contact * F + k]));
  return most * (law->kv + law->ku[0] + law->ku[2]) <= UNSEEN * scale;
}

/* Whether a contact starts where a path ended; not so before the first step. */
static bool has_ended_at(const mhb_contact_path *path, const mhb_contact_point *point) {
  bool same = path->share[0] + path->share[1] + path->share[2] > 0 &&
              path->end.state == point->state && path->end.zeta[0] == point->zeta[0] &&
              path->end.zeta[1] == point->zeta[1];
  for (int c = 0; c < 3; c++)
    same = same && path->end.u[c] == point->u[c] && path->end.p[c] == point->p[c];
  return same;
}

/* Forces of the step before at the stages of the next: the quadratic goes on where nothing changed,
 * else the force stays. */
static void guess(mhb_joint_step *o, const mhb_contact_point *point) {
  memset(o->motion, 0, sizeof *o->motion * (size_t)(o->ring->s.blades * S * o->ring->s.modes));
  memset(o->force, 0, sizeof *o->force * (size_t)(F * o->ring->s.contacts));
  for (int j = 0; j < o->ring->s.contacts; j++) {
    const mhb_contact_path *last    = &o->path[j];
    const bool              goes_on = last->events == 0 && has_ended_at(last, &point[j]);
    double                  p[F];
    for (int k = 0; k < F; k++) {
      p[k] = goes_on ? 0 : point[j].p[k % 3];
      for (int i = 0; i < S && goes_on; i++) p[k] += o->onward[k / 3][i] * last->p[3 * i + k % 3];
    }
    put_forces(o, j, p);
    o->seen[j * F] = INFINITY;
  }
}

int mhb_joint_step_solve(mhb_joint_step *o, const mhb_contact_point *point, const double *y,
                         double scale) {
  int pairs = o->ring->s.pairs, contacts = o->ring->s.contacts;
  guess(o, point);
  for (int sweep = 0; sweep < MAX_SWEEPS; sweep++) {
    double worst = 0;
    o->sweeps++;
    for (int j = 0; j < contacts; j++) {
      const mhb_contact_spring *spring = &o->spring[j % pairs];
      double                    w[F], start[3];
      set_motion(o, j, y + j * F, w);
      if (is_seen(o, j, w, scale)) continue;
      for (int c = 0; c < 3; c++) {
        start[c] = point[j].u[c];
        for (int k = 0; k < 3; k++) start[c] += spring->R[c][k] * point[j].p[k];
      }
      if (!mhb_contact_path_follow(&o->ring->rule, spring, o->h, &point[j], start, w, scale,
                                   &o->path[j]))
        return 0;
      memcpy(o->seen + j * F, w, sizeof w);
      worst = fmax(worst, put_forces(o, j, o->path[j].p));
    }
    if (worst <= SOLVED * scale) return 1;
  }
  return 0;
}

/* ---- coefficients ---- */

void mhb_joint_step_set(mhb_joint_step *o, const mhb_modal_step *modal, const mhb_law *law) {
  const mhb_ring_step *ring = o->ring;
  const int            n3   = 3 * ring->s.pairs;
  o->h                      = modal->h;
  for (int i = 0; i < S; i++) mhb_radau_lagrange(&ring->rule, 1 + ring->rule.c[i], o->onward[i]);
  mhb_modal_step_response(ring, modal, o->response);
  for (int k = 0; k < ring->n_neighbours * n3 * n3; k++)
    o->R[k] = mhb_ring_step_flexibility(ring, k / (n3 * n3), k / n3 % n3, k % n3);
  for (int a = 0; a < ring->s.pairs; a++) {
    double R[3][3];
    for (int i = 0; i < 9; i++) R[i / 3][i % 3] = o->R[(3 * a + i / 3) * n3 + 3 * a + i % 3];
    mhb_contact_spring_set(&law[a], R, &o->spring[a]);
  }
}

mhb_joint_step *mhb_joint_step_create(const mhb_ring_step *ring) {
  const mhb_modal_structure *s = &ring->s;
  const size_t               m = (size_t)s->modes, n3 = 3 * (size_t)s->pairs;
  const size_t               contacts = (size_t)s->contacts;
  mhb_joint_step            *o        = shb_alloc_zeroed(1, sizeof *o);
  o->ring                             = ring;
  o->response                         = shb_arena_take(&o->arena, S * S * m, sizeof(double));
  o->motion = shb_arena_take(&o->arena, (size_t)s->blades * S * m, sizeof(double));
  o->force  = shb_arena_take(&o->arena, F * contacts, sizeof(double));
  o->R      = shb_arena_take(&o->arena, (size_t)ring->n_neighbours * n3 * n3, sizeof(double));
  o->seen   = shb_arena_take(&o->arena, F * contacts, sizeof(double));
  o->spring = shb_arena_take(&o->arena, (size_t)s->pairs, sizeof *o->spring);
  o->path   = shb_arena_take(&o->arena, contacts, sizeof *o->path);
  return o;
}

void mhb_joint_step_destroy(mhb_joint_step *o) {
  if (!o) return;
  shb_arena_free(&o->arena);
  free(o);
}
