/* The modal file of a case as its balance takes it: one model, or in a run-up those of every speed. */
#ifndef CASES_COMMANDS_LOAD_MODEL_H
#define CASES_COMMANDS_LOAD_MODEL_H

#include "cases/parse/case_file.h"
#include "mhb/structure/speed_model.h"

typedef struct {
  modal_model      model; /* in a run-up that at the upper end of mhb.frequency; freed with this */
  mhb_settings     settings; /* the case's, with the run-up */
  mhb_speed_table *run_up;   /* NULL: one speed */
  mhb_speed_model *top;      /* whose model it is then */
} case_model;

/* modes  in   keep that many (residuals: those left out answer statically, else not at all); 0: as they are
 * Errors: as modal_speeds_read, mhb_speed_table_create. To be freed in any case. */
shb_status case_model_read(const case_file *file, const char *path, int modes, bool residuals,
                           case_model *model);
void       case_model_free(case_model *model);

#endif
