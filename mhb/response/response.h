/* The response of a case, branch by branch, in memory and as the file NAME.response.h5. */
#ifndef MHB_RESPONSE_RESPONSE_H
#define MHB_RESPONSE_RESPONSE_H

#include "mhb/response/response_types.h"

/* NULL: a number is negative. */
mhb_response *mhb_response_create(int n_pairs, int n_probes, int n_harmonics);
void          mhb_response_destroy(mhb_response *response);

/* A response without branches for the same pairs, probes, interfaces and kept multipliers, for work
 * that is not to be seen yet. */
mhb_response *mhb_response_like(const mhb_response *response);

/* Interfaces of the pairs, n >= 2: name[n] and interface[pair] are copied. */
void mhb_response_interfaces(mhb_response *response, int n, char *const *name, const int *interface,
                             int lead);

/* Names in files and tables: of a kind of branch, such as "nonlinear"; of special, "" for
 * MHB_ORDINARY. */
const char *mhb_branch_kind_name(mhb_branch_kind kind);
const char *mhb_special_name(int special);

/* Whether all contacts stick or are open throughout, at a point. */
bool mhb_response_is_linear(const mhb_response *response, const mhb_branch *branch, int point);
/* The harmonic of a branch whose amplitude outputs have, its last one at most: the excitation's
 * first but with mhb.output_harmonic. */
int mhb_response_harmonic(const mhb_response *response, const mhb_branch *branch);
/* Amplitude of that harmonic, m: its semi-major axis (mhb/numerics/extent.h). Its rss or the peak
 * to peak instead where outputs of the response have that (mhb.output_quantity).
 *   place  in  a probe, or the number of probes plus a pair, whose motion it is */
double mhb_response_amplitude(const mhb_response *response, const mhb_branch *branch, int point,
                              int place);
/* That of the first probe. Without probes it is that of the first pair's motion. */
double mhb_response_output(const mhb_response *response, const mhb_branch *branch, int point);

/* Appends an empty branch, its own main one; returns its index. */
int mhb_response_branch(mhb_response *response, mhb_branch_kind kind);
/* Appends a point of zeros; returns its index. The arrays of the branch may move. */
int mhb_response_point(mhb_response *response, int branch);
/* Moves the last point of a branch to place at; those from there on move up by one. */
void mhb_response_place(mhb_response *response, int branch, int at);
/* Appends points first..last of a branch of another response of the same shape, in this order: from
 * the last to the first if first > last. A branch of fewer harmonics is widened. */
void mhb_response_copy_points(mhb_response *to, int to_branch, const mhb_response *from,
                              int from_branch, int first, int last);
/* A branch gets room for so many harmonics; those it has not are 0. It may have no modal amplitudes
 * yet. */
void mhb_response_widen(const mhb_response *response, mhb_branch *branch, int n_harmonics);
/* Appends a search to the records of a branch. */
void mhb_response_note_search(mhb_branch *branch, const mhb_search *search);
/* to <- the text and the sweep of the motion that lasts; those it had are freed. */
void mhb_response_copy_lasting(mhb_branch *to, const mhb_branch *from);
/* Room for n windows of a sweep; an earlier one is freed. */
void mhb_response_lasting_curve(mhb_branch *branch, int n);

/* Chance that all of lasting_starts miss a motion that one start in six reaches: (5/6)^starts. */
double mhb_response_lasting_missed(int starts);
/* Room for the modal amplitudes of n points; earlier ones are freed. */
void mhb_response_modal(const mhb_response *response, mhb_branch *branch, int n, int n_contact);
/* Removes the branches for which drop[n_branches] is true; main is adjusted. */
void mhb_response_drop(mhb_response *response, const bool *drop);
/* Puts secondary branches behind all main ones, those of one main branch together, in the order in
 * which they were found. */
void mhb_response_sort(mhb_response *response);

/* Moves the branches of other to response; they keep their harmonics. SHB_ERR_INPUT: other pairs,
 * probes, subharmonics, interfaces or parameter. */
shb_status mhb_response_merge(mhb_response *response, mhb_response *other);

/* A curve under way without segments, for those of a response. */
mhb_unfinished *mhb_unfinished_create(const mhb_response *like);
void            mhb_unfinished_destroy(mhb_unfinished *unfinished);
/* The first n segments with their points, and a copy of their states. */
mhb_unfinished *mhb_unfinished_copy(const mhb_response *segments, int n,
                                    const mhb_trace_state *state);

/* Writes by a temporary file, fsync and rename; reads back with full checks. SHB_ERR_IO,
 * SHB_ERR_INPUT. */
shb_status mhb_response_write(const mhb_response *response, const char *path,
                              const shb_provenance *provenance);
shb_status mhb_response_read(const char *path, mhb_response **response);

/* Points of the balance whose error is above the tolerance, of all branches. Samples of random
 * rings whose peak is such a point, of all preloads. */
typedef struct {
  int    points, marked;
  int    samples, marked_samples; /* done; of them */
  double largest;                 /* error_truncation of a marked one */
  int    harmonics;               /* most of a marked one; 0: not known */
} mhb_marks;

mhb_marks mhb_response_marks(const mhb_response *response);

/* Whether a mean friction that nothing determines loads others: a pair that moves, or pairs that
 * touch on the same contact. Alone on its contact, with all others stuck or open, it changes no
 * motion. The rule of MHB_TRACTION_UNDETERMINED.
 *   on_contact  in  pairs of one contact, n_pairs is a multiple
 *   free_mean   in  [n_pairs] the pair sticks all the time although it can slip
 *   share       in  [n_pairs][3] of the period: stuck, slipping, open */
bool mhb_friction_loads_others(int n_pairs, int on_contact, const bool *free_mean,
                               const double *share);

/* Whether the error of a point is above the tolerance: it is no result. */
bool mhb_branch_marked(const mhb_branch *branch, int point);

#endif
