/* The modal stage at one speed: from a mesh and settings to the modal model. */
#ifndef MODAL_STAGE_SOLVE_H
#define MODAL_STAGE_SOLVE_H

#include "fem/body/assemble.h"
#include "fem/body/rotating_body.h"
#include "fem/element/load.h"
#include "fem/element/material.h"
#include "mesh/base/progress.h"
#include "modal/condense/contact_patches.h"
#include "modal/condense/residual_shapes.h"
#include "modal/condense/static_deflection.h"
#include "modal/eigen/eigen.h"
#include "modal/eigen/participation.h"
#include "modal/model/damping.h"
#include "modal/model/model.h"

typedef struct {
  const char *name;
  double      at[3]; /* m, mesh axes */
} modal_probe;

/* A contact interface, given by the groups of its faces. */
typedef struct {
  const char   *name; /* "": the only one */
  const char   *right, *left;
  bool          to_ground; /* the left face does not matter */
  int           points;    /* patches; 0: one for each node */
  const double *psi, *phi; /* rad, checked against the faces; NULL: not given */
} modal_contact;

/* A volume of the mesh and its material. */
typedef struct {
  const char  *name; /* NULL: the whole mesh */
  fem_material material;
} modal_region;

typedef struct {
  int                  n_regions; /* 1 at least */
  const modal_region  *region;
  mesh_axis            axis;
  int                  blades;
  double               speed;    /* rad/s; 0: at rest */
  int                  n_speeds; /* of modal_stage; above 1: all of speeds, which include speed */
  const double        *speeds;   /* [n_speeds] rad/s, distinct */
  fem_turning          coriolis; /* with Coriolis terms of a rotor that turns this way */
  double               pressure; /* Pa, steady, on group load, into the deformed surface */
  int                  modes;    /* 0: as many as tolerance and band need */
  double               tolerance, band; /* of the contact receptance; Hz */
  modal_damping        damping;
  modal_check_kind     check;            /* that no mode is missing */
  bool                 spares_stiffness; /* the system of a blade at rest has no K afterwards */
  bool                 full_integration; /* stiffness with FEM_FULL, not FEM_STANDARD */
  int                  n_loads;          /* 0: no load at all */
  const fem_load      *loads;            /* loads that act together */
  int                  n_groups;         /* further face groups that loads name */
  const char          *group[MESH_MAX_MORE];
  int                  n_probes;
  const modal_probe   *probe;
  bool                 may_be_free; /* without the groups of contact there is no contact */
  int                  n_diameters; /* of a sector with a disc, besides 0; -1: all to N/2 */
  const int           *diameter;    /* [n_diameters] from 0 */
  int                  n_contacts;  /* 1 at least */
  const modal_contact *contact;
} modal_settings;

/* The body of the settings with its materials and element tables. */
typedef struct {
  fem_body     body;
  fem_material material[MESH_MAX_VOLUMES];
  fem_element  element;
} modal_body;

/* Free with free, also after an error. The mesh must outlive it. */
shb_status modal_body_create(const mesh_fe *mesh, const modal_settings *settings,
                             modal_body **body);

/* Results of the stage. The model is the same on every rank. */
typedef struct {
  fem_system            system;
  modal_eigen           eigen;
  modal_patches         patches; /* all patches, ordered by interface */
  modal_model           model;
  modal_deflection      deflection; /* static, under the centrifugal load; zero at rest */
  modal_participation   participation;
  modal_residual_shapes residual;
  modal_condensation    to;       /* dofs that were condensed to */
  fem_turning           coriolis; /* of the Coriolis matrix in the model */
} modal_result;

/* Give a model the names of probes and interfaces, normals and areas. */
void modal_label(const modal_settings *settings, const modal_patches *patches, modal_model *model);

/* Assemble, solve the static equilibrium if the blade rotates, compute the modes, condense. K is
 * then the tangent stiffness at that equilibrium. Contact faces, axes and loads are those of the
 * undeformed mesh. Of a sector with a disc (mesh->image) this is nodal diameter 0. Collective; the
 * mesh is the same on every rank, its sets oriented (mesh_fe_orient).
 *
 * Errors:
 *
 *   SHB_ERR_INPUT      missing groups, wrong angles, too many modes or patches, a part without
 *                      clamp, a single column of hexahedra without full_integration, a speed
 *                      without stable equilibrium
 *   SHB_NOT_CONVERGED  modes
 *   SHB_INTERRUPTED */
shb_status modal_solve(MPI_Comm comm, const mesh_fe *mesh, const modal_settings *settings,
                       shb_progress *progress, modal_result *result);

void modal_result_free(modal_result *result); /* also on a zeroed struct */

#endif
