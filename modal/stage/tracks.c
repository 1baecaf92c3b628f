#include "modal/stage/tracks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/base/memory.h"

/* Match rows and columns by decreasing overlap, each once. next[i]: column of row i. */
static void match(int m, const double *overlap, int *next) {
  for (int i = 0; i < m; i++) next[i] = -1;
  for (int round = 0; round < m; round++) {
    int best[2] = {-1, -1};
    for (int j = 0; j < m; j++) {
      bool taken = false;
      for (int i = 0; i < m; i++) taken = taken || next[i] == j;
      for (int i = 0; i < m && !taken; i++)
        if (next[i] < 0 && (best[0] < 0 || overlap[i * m + j] > overlap[best[0] * m + best[1]]))
          best[0] = i, best[1] = j;
    }
    next[best[0]] = best[1];
  }
}

void modal_tracks_continue(const double *overlap, int s, int *next, modal_speeds *speeds) {
  const int m   = speeds->n_modes;
  int      *now = speeds->mode + (size_t)s * (size_t)m;
  double   *mac = speeds->mac + (size_t)s * (size_t)m;
  if (overlap) match(m, overlap, next);
  for (int t = 0; t < m; t++) {
    const int i = overlap ? now[t - m] : t; /* the track's mode at the speed before */
    now[t]      = overlap ? next[i] : t;
    mac[t]      = overlap ? fmin(1, pow(overlap[i * m + now[t]], 2)) : 1;
  }
}

static void create_speeds(const modal_nodal_diameters *models, int i, int n, const double *speed,
                          int m, modal_speeds *out) {
  modal_speeds_create(n, m, out);
  memcpy(out->speed, speed, (size_t)n * sizeof *speed);
  out->overlap = shb_alloc_zeroed((size_t)n * (size_t)m * (size_t)m, sizeof *out->overlap);
  if (2 * models->diameter[i] != models->blades) modal_speeds_make_complex(out);
}

void modal_sector_tracks_create(const modal_nodal_diameters *models, int n, const double *speed,
                                int m, modal_sector_speeds *speeds, modal_sector_tracks *tracks) {
  *tracks = (modal_sector_tracks){.speeds = speeds};
  modal_sector_speeds_create(models->blades, models->n, speeds);
  memcpy(speeds->diameter, models->diameter, (size_t)models->n * sizeof *models->diameter);
  for (int i = 1; i < models->n; i++) create_speeds(models, i, n, speed, m, &speeds->at[i]);
  tracks->first  = shb_alloc_zeroed((size_t)models->n, sizeof *tracks->first);
  tracks->before = shb_alloc_zeroed((size_t)models->n, sizeof *tracks->before);
}

void modal_sector_tracks_free(modal_sector_tracks *tracks) {
  for (int i = 0; tracks->first && i < tracks->speeds->n; i++) free(tracks->first[i]);
  for (int i = 0; tracks->before && i < tracks->speeds->n; i++) free(tracks->before[i]);
  free(tracks->first);
  free(tracks->before);
  *tracks = (modal_sector_tracks){0};
}

/* Overlap of the first speed's modes with those at s; C: scratch. */
static void store_overlap(const double complex *first, int s, const wave_modes *modes,
                          double complex *C, modal_speeds *out) {
  const size_t m = (size_t)out->n_modes, at = (size_t)s * m * m;
  wave_inner(modes->order, modes->n, first, modes->n, modes->m_phi, C);
  for (size_t i = 0; i < m * m; i++) {
    const double complex value = C[i % m * m + i / m];
    out->overlap[at + i]       = creal(value);
    if (out->overlap_imaginary) out->overlap_imaginary[at + i] = cimag(value);
  }
}

static void follow(const double complex *before, int s, const wave_modes *modes, double complex *C,
                   modal_speeds *out) {
  const size_t m       = (size_t)out->n_modes;
  double      *overlap = shb_alloc(m * m, sizeof *overlap);
  int         *next    = shb_alloc(m, sizeof *next);
  wave_inner(modes->order, modes->n, before, modes->n, modes->m_phi, C);
  for (size_t i = 0; i < m * m; i++) overlap[i] = cabs(C[i % m * m + i / m]);
  modal_tracks_continue(overlap, s, next, out);
  free(overlap);
  free(next);
}

static double complex *copy_of(const double complex *phi, size_t n) {
  return memcpy(shb_alloc(n, sizeof *phi), phi, n * sizeof *phi);
}

void modal_sector_tracks_take(modal_sector_tracks *tracks, int i, wave_modes *modes) {
  modal_speeds   *out = &tracks->speeds->at[i];
  const int       s   = tracks->s;
  const size_t    m   = (size_t)modes->n;
  double complex *C   = shb_alloc(m * m, sizeof *C);
  if (s == 0) tracks->first[i] = copy_of(modes->phi, m * modes->order);
  if (s == 0)
    modal_tracks_continue(NULL, s, NULL, out);
  else
    follow(tracks->before[i], s, modes, C, out);
  store_overlap(tracks->first[i], s, modes, C, out);
  free(C);
  free(tracks->before[i]);
  tracks->before[i] = modes->phi;
  modes->phi        = NULL;
}
