/* A rung of a convergence study: a setting of the balance, its cost, its distance from a finer one.
 *
 * A process of its own computes one rung, so its memory is measured alone and a crash affects
 * only its row. It writes
 *   STEM.response.h5        the curves; again only if settings, modal file or program have changed
 *   STEM.cost               seconds, memory, peaks
 *   STEM.REF.error          distance of the curves from those of the rung with stem REF
 *   STEM.integration.error  distance from points of time integration
 * REF is the last part of a stem, in the same or another folder. */
#ifndef CASES_CONVERGE_RUNG_H
#define CASES_CONVERGE_RUNG_H

#include "cases/parse/case_file.h"
#include "mhb/response/response.h"
#include "postproc/analysis/outputs.h"

typedef struct {
  int    harmonics; /* 0: auto */
  double tolerance; /* of the motion, with auto; else 0 */
  double accuracy;  /* of the contact law */
  int    modes;     /* kept of the modal file */
  bool   residuals; /* with residual flexibility and inertia */
  int    patches;   /* that the pairs of the modal file are joined to; 0: not joined */
} rung_setting;

typedef struct {
  double n0, frequency, amplitude; /* N, Hz, m; NAN if there is none */
} rung_peak;

typedef struct {
  double    seconds; /* of the balance alone on one core, least of the runs */
  double    setup;   /* s of one core from the start of the program to the first run */
  double    memory;  /* largest resident memory, bytes */
  int       runs, points;
  int       harmonics, unknowns; /* largest of all points */
  bool      complete;            /* every curve covered the range */
  int       n_peaks;
  rung_peak peak[MHB_MAX_PRELOADS]; /* highest of each preload */
} rung_cost;

typedef struct {
  double
      /* distance of the curves, largest over the preloads; see
       * postproc/analysis/curve_distance.h */
      curve;
  int n,
      /* points compared; those of them compared by interpolation, where the balance has no
       * solution */
      lost;
} rung_error;

enum { RUNG_WORDS = 16, RUNG_WORD = 64 };

/* Convert a setting to words for a command line and back. True if the words are a setting. */
enum { RUNG_SETTING_WORDS = 6 };
void rung_words(const rung_setting *setting, char words[RUNG_SETTING_WORDS][RUNG_WORD]);
bool rung_from_words(const char *const words[RUNG_SETTING_WORDS], rung_setting *setting);

/* Name of a setting in file names, e.g. "h7_a1e-08_m20" or "h7_a1e-08_m20_p4". */
void rung_name(const rung_setting *setting, char name[RUNG_WORD]);

/* Change the case to that of a rung: main curves only, no stability, preloads outside converge.n0
 * left out. Errors: SHB_ERR_INPUT none is left. */
shb_status rung_apply(const rung_setting *setting, case_file *file);

/* The output that converge.output names, or the primary one.
 *   names  in  probes of the model
 * Errors: SHB_ERR_INPUT no such output. */
shb_status rung_output(const case_file *file, int n_probes, char *const *names,
                       post_output *output);

/* Read and write the small files.
 *   name, file  in  REF or "integration", and the HDF5 file that the rung was compared with
 * Reading fails with SHB_ERR_IO if the file is missing or cut, or if either HDF5 file has changed
 * since. */
shb_status rung_cost_write(const rung_cost *cost, const char *stem);
shb_status rung_cost_read(const char *stem, rung_cost *cost);
shb_status rung_error_write(const rung_error *error, const char *stem, const char *name,
                            const char *file);
shb_status rung_error_read(const char *stem, const char *name, const char *file, rung_error *error);

/* STEM.response.h5; malloc'ed. */
char *rung_response(const char *stem);
/* The last part of a stem. */
const char *rung_leaf(const char *stem);

/* Relative errors of the peaks against those of a finer rung, largest over the preloads. NAN if
 * either has no peak. */
void rung_peak_errors(const rung_cost *cost, const rung_cost *reference, double *amplitude,
                      double *frequency);

#endif
