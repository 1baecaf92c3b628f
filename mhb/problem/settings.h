/* Settings of the harmonic balance and the time integration: contact parameters and sweep. Plain
 * data, SI. */
#ifndef MHB_PROBLEM_SETTINGS_H
#define MHB_PROBLEM_SETTINGS_H

#include <stdbool.h>

typedef enum { MHB_EQUILIBRIUM, MHB_INTERFERENCE } mhb_preload;

/* Multipliers: where they cost little and at a few points elsewhere; at every point; never. */
typedef enum { MHB_STABILITY_AUTO, MHB_STABILITY_ALWAYS, MHB_STABILITY_NEVER } mhb_stability_when;

/* Motion that takes over where the wave is unstable: at few points; at all of them; never. */
typedef enum { MHB_LASTING_AUTO, MHB_LASTING_ALWAYS, MHB_LASTING_NEVER } mhb_lasting_when;

/* Size of an output whose peaks are located, in the order of the key (mhb/numerics/extent.h). It is
 * the largest displacement of one harmonic, the peak to peak of all, or the rss of one. */
typedef enum { MHB_OUTPUT_HARMONIC, MHB_OUTPUT_PEAK_TO_PEAK, MHB_OUTPUT_RSS } mhb_output_quantity;

/* Special points that are followed along a parameter. */
typedef enum {
  MHB_TRACK_NOTHING,
  MHB_TRACK_PEAKS,
  MHB_TRACK_FOLDS,
  MHB_TRACK_FLIPS,
  MHB_TRACK_NEIMARK_SACKERS,
  MHB_N_TRACKS
} mhb_track;

/* Continuation parameter. */
typedef enum {
  MHB_IN_FREQUENCY,
  MHB_IN_N0,
  MHB_IN_SCALE,
  MHB_IN_MU,
  MHB_IN_KU,
  MHB_IN_KV,
  MHB_N_PARAMETERS
} mhb_parameter;

enum {
  MHB_MAX_INTERFACES    = 8,
  MHB_NAME              = 81,
  MHB_MAX_PRELOADS      = 256,
  MHB_MAX_SEARCH_AT     = 64,
  MHB_MAX_SEARCH_ORDERS = 8,
  MHB_MAX_SAVED         = 64
};

/* A contact interface; totals over its pairs. */
typedef struct {
  char   name[MHB_NAME];
  bool   to_ground;
  bool   has_psi, has_phi;
  double psi, phi, mu, kv, ku[3];
  int    n_preloads; /* as many as those of the leading one, or 1 */
  double n0[MHB_MAX_PRELOADS];
} mhb_interface;

/* A few starts at the lowest and highest peaks of all preloads, as a share of the work. */
enum { MHB_SEARCH_PEAKS = -1 };

/* Search for branches without a connection to the main one, beside each main branch. */
typedef struct {
  int    starts; /* random starts a frequency and order; 0: no search; MHB_SEARCH_PEAKS */
  int    n_at;   /* 0: the program chooses */
  double at[MHB_MAX_SEARCH_AT];                  /* as range: Hz for the frequency */
  int    n_orders, order[MHB_MAX_SEARCH_ORDERS]; /* ascending, times subharmonics */
} mhb_search_settings;

/* Points of which modal amplitudes are kept. Peaks: those of any output, and the highest point of
 * each curve. Listed: where a curve passes one of the frequencies, the nearer point. */
typedef enum { MHB_SAVE_PEAKS, MHB_SAVE_ALL, MHB_SAVE_LISTED } mhb_save_when;

typedef struct {
  mhb_save_when what;
  int           n;
  double        frequency[MHB_MAX_SAVED]; /* Hz */
} mhb_save_settings;

/* Another model of the same contact faces (mhb/problem/other_pairs.h). */
typedef struct mhb_other_pairs mhb_other_pairs;

typedef struct {
  bool                to_ground;
  int                 engine_order, blades; /* E of the machine, N; the wave: mhb/problem/wave.h */
  bool                turns_right;          /* the rotor, towards +tangential */
  bool                has_psi, has_phi; /* given in the case; else from the modal file's normals */
  double              psi, phi;         /* rad */
  double              mu, kv;           /* -, N/m: totals of the interface */
  double              ku[3];            /* kuu, kuw, kww, N/m */
  mhb_preload         preload;
  int                 n_preloads;
  double              n0[MHB_MAX_PRELOADS]; /* N */
  int                 n_interfaces;         /* 0, 1: the parameters above are all */
  int                 lead; /* index of the leading interface, whose parameters are those above */
  bool                together; /* the parameter followed changes in all interfaces in proportion */
  mhb_interface       interface[MHB_MAX_INTERFACES];
  double              frequency[2]; /* Hz, first < second; equal if another parameter is followed */
  mhb_parameter       parameter;    /* followed, in its unit from range[0] to range[1] */
  double              range[2];     /* not for the frequency */
  int                 harmonics;    /* m >= 1 */
  int                 subharmonics; /* nu >= 1: fundamental is omega/nu */
  double              motion_tolerance; /* > 0: harmonics are chosen for this relative error */
  double              scale;            /* multiplies the excitation */
  double              tolerance;        /* of the contact law, relative to its largest force */
  int                 max_points; /* a branch ends (with a reason) beyond this, default 20000 */
  mhb_search_settings search;
  bool                flips;     /* branches of doubled period are followed from flips */
  mhb_stability_when  stability; /* points at which multipliers are computed */
  mhb_lasting_when    lasting;   /* points at which the motion that takes over is integrated */
  mhb_save_settings   save;      /* points of which modal amplitudes are kept */
  mhb_track           track;     /* followed along the parameter over range, within frequency */
  char                output[MHB_NAME]; /* whose peak: a probe or "contact"; "": the first probe */
  mhb_output_quantity output_quantity;
  int output_harmonic; /* of the excitation: of outputs whose peaks are located; 0, 1: the first */
  const struct mhb_speed_table
      *run_up; /* NULL: one speed. Else the modal model follows the frequency. */
  const struct modal_nodal_diameters
      *nodal_diameters; /* NULL: a clamped blade. Else harmonic k has the model of its own. */
  const struct mhb_disc_table
      *disc_run_up; /* run-up of a disc; run_up is then its table of nodal diameter 0 */
  /* NULL: equal blades that move as one wave. Else every blade has its own model, and the modal
   * model of the balance is that of the whole ring (mhb/mistuning/mistuned_ring.h). */
  const struct mhb_mistuned_ring *ring;
  /* A receptance of the same model. Receptances with its axes of the pairs use its residual
   * matrices; it must outlive them. NULL: each makes its own. */
  const struct mhb_receptance *alike;
  /* Equal groups of consecutive pairs, each a contact with the stiffness and preload of the case.
   * 0, 1: all pairs are one contact. */
  int                              contacts;
  const struct modal_contact_face *face; /* for maps of the contact at peaks; NULL: none */
  const mhb_other_pairs *other_pairs; /* by which the spatial error is estimated; NULL: it is not */
  /* The curve in outline, with a fixed number of harmonics: peaks are not located, and the errors
   * of points are unknown (NAN). The linear limits have no points. */
  bool outline;
  bool resume;  /* take over the finished branches of an interrupted run of equal settings */
  int  sharing; /* processes that share the memory, each with such a balance; 0: one */
} mhb_settings;

/* Whether points get a verdict. On a disc disturbances of every nodal diameter are followed: the
 * modal file must hold all of them. */
bool mhb_judges_stability(const mhb_settings *settings);

/* Points by time integration (mhb/integration/integration_sweep.h). */
typedef enum {
  MHB_START_FROM_BALANCE,
  MHB_START_FROM_REST,
  MHB_START_FROM_STATE
} mhb_integration_start;
typedef enum { MHB_SWEEP_UP, MHB_SWEEP_DOWN, MHB_SWEEP_BOTH } mhb_integration_direction;

enum { MHB_MAX_FREQUENCIES = 1000 };

typedef struct {
  int    n_frequencies;
  bool   listed; /* frequency holds them; else they are spaced evenly over the range */
  double frequency[MHB_MAX_FREQUENCIES]; /* Hz, of the excitation */
  mhb_integration_start     start;
  mhb_integration_direction direction; /* for MHB_START_FROM_STATE */
  int                       steps;     /* a period of the fundamental, at first */
  double                    tolerance; /* relative to the motion */
  int                       max_periods;
  int                       harmonics; /* of the fundamental, kept; 0: as many as the balance */
} mhb_integration_settings;

/* As the case and the response file have it. */
const char *mhb_track_word(mhb_track track);

/* "harmonic", "peak_to_peak" or "rss", as in mhb.output_quantity. */
const char *mhb_output_quantity_word(mhb_output_quantity quantity);

/* Whether such points are those of a multiplier on the unit circle; NULL: no. */
bool mhb_track_by_multiplier(const char *word);

#endif
