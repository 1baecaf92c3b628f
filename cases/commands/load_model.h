/* The modal file of a case as the balance uses it: one model, or the models of a run-up. */
#ifndef CASES_COMMANDS_LOAD_MODEL_H
#define CASES_COMMANDS_LOAD_MODEL_H

#include "cases/commands/contact_points.h"
#include "cases/parse/case_file.h"
#include "mhb/mistuning/mistuned_ring.h"
#include "mhb/run_up/disc_speeds.h"
#include "mhb/run_up/stuck_frequencies.h"
#include "mhb/structure/receptance.h"
#include "modal/model/contact_face.h"
#include "modal/model/nodal_diameters.h"

typedef struct {
  modal_model  model; /* in a run-up the one at the upper end of mhb.frequency; owned. Of a ring of
                      * different blades that of the whole ring */
  mhb_settings settings;         /* of the case, including the run-up and the ring */
  modal_model  tuned;            /* with a ring: the blade of the file; owned */
  modal_nodal_diameters *disc;   /* NULL: a clamped blade; else model is that of its first; owned,
                                  * but in a run-up */
  mhb_mistuned_ring     *ring;   /* NULL: equal blades */
  mhb_speed_table       *run_up; /* NULL: one speed */
  mhb_speed_model       *top;    /* owner of the model in a run-up */
  mhb_disc_table        *disc_run_up; /* run-up of a disc, owner of run_up */
  mhb_disc_speeds       *disc_top;    /* owner of disc and top there */
  modal_contact_face     face;        /* for maps; without nodes: none */
  mhb_diagrams           diagrams;    /* of the ring, for the file */
  contact_points        *points;      /* the model's finer or coarser one; NULL: none */
} case_model;

/* Read the modal file at path, with all speeds in a run-up.
 *
 *   modes      in  number of modes kept; 0: all
 *   residuals  in  true: modes left out respond quasi-statically; false: not at all
 *
 * With contact.points: auto the pairs of the file are joined to as many as the case needs.
 *
 * Errors: as modal_speeds_read, contact_points_choose, mhb_speed_table_create. To be freed in any
 * case. */
shb_status case_model_read(const case_file *file, const char *path, int modes, bool residuals,
                           case_model *model);

/* Join the pairs of a model, which has all pairs of its file, to patches. */
shb_status case_model_join(case_model *model, int patches);

/* Estimate the spatial error from half as many pairs, where no finer model does. */
shb_status case_model_judge_points(case_model *model);

/* Maps of the contact at peaks: the face of the modal file at path, if it holds one. */
shb_status case_model_face(case_model *model, const char *path);

/* Frequencies of the ring with stuck contacts, of the modal file at path. */
shb_status case_model_diagrams(const case_file *file, case_model *model, const char *path);

void case_model_free(case_model *model);

#endif
