/* One rung of a convergence study: a setting of the balance, what it costs and how far it is from a finer one.
 *
 * A rung is worked out by the program shroudhb-rung, so that its memory is its own and a crash costs one row. It leaves
 *   STEM.response.h5   the curves, made anew only when settings, modal file or program have changed
 *   STEM.cost          seconds, memory, peaks
 *   STEM.REF.error     the curves' distance from those of the rung with the stem's leaf REF, in the same or another folder
 *   STEM.integration.error  its distance from points of time integration */
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
} rung_setting;

typedef struct {
  double n0, frequency, amplitude; /* N, Hz, m; NAN if there is none */
} rung_peak;

typedef struct {
  double    seconds; /* of the balance alone, one core: the least of the runs */
  double    setup;   /* s of one core, from the start of the program to that of the first run */
  double    memory;  /* greatest resident memory, bytes */
  int       runs, points;
  int       harmonics, unknowns; /* the most of any point */
  bool      complete;            /* every curve covered the range */
  int       n_peaks;
  rung_peak peak[MHB_MAX_PRELOADS]; /* the highest of each preload */
} rung_cost;

typedef struct {
  double
      curve; /* distance of the curves, see postproc/analysis/curve_distance.h; the worst preload */
  int n,
      lost; /* points looked at; those compared by interpolation, as the balance could not be solved next to them */
} rung_error;

enum { RUNG_WORDS = 16, RUNG_WORD = 64 };

/* The setting as words for a command line, and back. true if they are a setting. */
enum { RUNG_SETTING_WORDS = 5 };
void rung_words(const rung_setting *setting, char words[RUNG_SETTING_WORDS][RUNG_WORD]);
bool rung_from_words(char *const words[RUNG_SETTING_WORDS], rung_setting *setting);

/* Name of a setting for files: "h7_a1e-08_m20". */
void rung_name(const rung_setting *setting, char name[RUNG_WORD]);

/* The case as a rung solves it: main curves only, stability is not judged, preloads outside converge.n0 are left out.
 * SHB_ERR_INPUT: none is left. */
shb_status rung_apply(const rung_setting *setting, case_file *file);

/* Which output converge.output names; primary if it is not given. names: probes of the model.
 * SHB_ERR_INPUT: no such output. */
shb_status rung_output(const case_file *file, int n_probes, char *const *names,
                       post_output *output);

/* Read and write the small files. Reading: SHB_ERR_IO if absent or cut, or if either file has changed since.
 *   name, file  in  what the rung was compared with: REF, or "integration", and the HDF5 file that holds it */
shb_status rung_cost_write(const rung_cost *cost, const char *stem);
shb_status rung_cost_read(const char *stem, rung_cost *cost);
shb_status rung_error_write(const rung_error *error, const char *stem, const char *name,
                            const char *file);
shb_status rung_error_read(const char *stem, const char *name, const char *file, rung_error *error);

/* STEM.response.h5; malloc'ed. */
char *rung_response(const char *stem);
/* What follows the folder. */
const char *rung_leaf(const char *stem);

/* Errors of the peaks against those of a finer rung: the worst preload, relative. NAN if either has none. */
void rung_peak_errors(const rung_cost *cost, const rung_cost *reference, double *amplitude,
                      double *frequency);

#endif
