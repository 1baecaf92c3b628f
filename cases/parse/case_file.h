/* A case file in memory: the settings of all stages, in SI units. */
#ifndef CASES_PARSE_CASE_FILE_H
#define CASES_PARSE_CASE_FILE_H

#include <stdbool.h>

#include "fem/body/rotation.h"
#include "fem/element/load.h"
#include "fem/element/material.h"
#include "mesh/blade/blade.h"
#include "mesh/gmsh/source_settings.h"
#include "mhb/problem/settings.h"
#include "modal/common/completeness.h"
#include "modal/model/damping.h"

enum { CASE_MAX_PROBES = 32, CASE_MAX_LOADS = 16, CASE_NAME = 64, CASE_MAX_BLADES = 1000 };

typedef enum {
  CASE_MESH      = 1,
  CASE_MODAL     = 2,
  CASE_MHB       = 4,
  CASE_POST      = 8,
  CASE_CONVERGE  = 16,
  CASE_INTEGRATE = 32,
  /* beside the others: a file of modes alone is in order, and read as one for CASE_MODAL */
  CASE_OR_MODES = 64
} case_stage;

typedef struct {
  char   name[CASE_NAME];
  double at[3]; /* m, mesh axes */
} case_probe;

typedef struct {
  char   name[CASE_NAME];
  double at[3], direction[3]; /* m; of any length; mesh axes */
} case_gauge;

/* Nodal diameters of a sector with a disc; what: place in the words of modal.nodal_diameters. */
enum { CASE_MOST_DIAMETERS = 501 };
typedef enum { CASE_DIAMETERS_AUTO, CASE_DIAMETERS_ALL, CASE_DIAMETERS_LISTED } case_diameters_kind;
typedef struct {
  case_diameters_kind what;
  int                 n, list[CASE_MOST_DIAMETERS]; /* with LISTED, ascending */
} case_diameters;

/* A contact interface. */
typedef struct {
  mhb_interface mhb;                               /* name "": the only one */
  char          right[MESH_WORD], left[MESH_WORD]; /* groups of faces */
  int           points;                            /* contact patches; 0 = all, -1 = auto */
} case_interface;

typedef struct {
  fem_load load;
  char    *field;            /* resolved path, or NULL */
  char     group[MESH_WORD]; /* "": the usual one */
} case_load;

/* A volume of the mesh and what it is made of. */
typedef struct {
  char            group[MESH_WORD];    /* "": the whole mesh */
  fem_orthotropic constants;           /* as given: E, nu, G, axes */
  fem_material    material;            /* stiffness and density in mesh axes */
  double          endurance, ultimate; /* Pa; 0: not given */
} case_material;

/* How the blades of a ring differ. */
typedef enum {
  CASE_TUNED, /* they do not */
  CASE_MISTUNED_LIST,
  CASE_MISTUNED_FILE,
  CASE_MISTUNED_RANDOM
} case_mistuning_kind;

typedef struct {
  case_mistuning_kind kind;
  int                 n;
  double              each[CASE_MAX_BLADES]; /* [n] relative frequency deviations */
  char               *file;                  /* resolved path */
  bool                hz;                    /* its numbers are frequencies */
  double              mean;                  /* Hz, of them; 0: of the table */
  double              deviation;             /* standard deviation of random ones */
  int                 seed, samples;         /* 0: none but the first */
} case_mistuning;

typedef struct {
  char *path;   /* as given */
  char *folder; /* of path, "." if none; outputs and relative input files live here */
  char *output; /* another folder for the outputs, or NULL */
  char *text;   /* verbatim */
  char *name;
  bool  only_modes; /* neither modal.file nor the blocks contact and mhb: for CASE_MODAL alone */

  bool        has_mesh;  /* block mesh present (needed unless modal.file) */
  char       *mesh_file; /* resolved path of mesh.file, or NULL: parametric blade */
  int         mesh_unit; /* place in the words of mesh.unit */
  mesh_source source;    /* mesh.file and the keys that belong to it */
  mesh_blade  blade;
  bool        has_disc; /* mesh.blade.disc is given */

  /* One or several: the block of the only one stands for a list of one. */
  bool           has_materials; /* the list is given */
  int            n_materials;   /* 1 at least */
  case_material  materials[MESH_MAX_VOLUMES];
  int            blades;
  case_mistuning mistuning; /* rotor.mistuning */
  int            n_speeds;
  double         speed[MHB_MAX_PRELOADS]; /* [n_speeds] rad/s, the last that of the response */
  bool           run_up;                  /* the speed follows the frequency */
  fem_turning    coriolis;                /* of the rotor; unsaid: without Coriolis terms */
  double         pressure;                /* Pa, steady */
  mesh_axis      axis;

  int              modes;           /* 0: auto */
  double           tolerance, band; /* with modes: auto; Hz */
  modal_damping    damping;
  modal_check_kind check;
  case_diameters   diameters;
  bool             full_integration; /* modal.integration: full */
  char            *modal_file;       /* resolved path of modal.file, or NULL */

  int        engine_order;
  bool       has_load;  /* any load is given */
  bool       has_loads; /* as a list */
  int        n_loads;   /* 1 at least */
  case_load  loads[CASE_MAX_LOADS];
  int        n_probes;
  case_probe probe[CASE_MAX_PROBES];
  int        n_gauges;
  case_gauge gauge[CASE_MAX_PROBES];

  bool           has_contact;      /* block contact present */
  double         points_tolerance; /* of contact.points: auto, relative to the motion */
  bool           has_interfaces;   /* the list is given */
  int            n_interfaces;     /* 1 at least */
  case_interface interfaces[MHB_MAX_INTERFACES];
  char           vary_interface[MHB_NAME]; /* mhb.vary.interface */
  mhb_settings   mhb;
  double         vary[MHB_N_PARAMETERS][2]; /* range of a parameter that is followed */

  double converge_tolerance;
  double converge_n0[2];   /* N, preloads that are looked at */
  double converge_seconds; /* the most that a rung's balance may take */
  char  *converge_output;  /* name of a probe or "contact"; NULL: the first */

  mhb_integration_settings integrate;

  bool no_memory; /* while it was read; of a case that was refused too */
} case_file;

/* Whether the contact patches are as many as a tolerance needs. */
static inline bool case_points_are_auto(const case_file *file) {
  return file->interfaces[0].points < 0;
}

#endif
