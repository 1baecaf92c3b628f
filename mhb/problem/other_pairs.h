/* Another model of the same contact faces, with more pairs or fewer. */
#ifndef MHB_PROBLEM_OTHER_PAIRS_H
#define MHB_PROBLEM_OTHER_PAIRS_H

#include "mhb/problem/settings.h"
#include "modal/model/joined_pairs.h"

/* The model and the joining must outlive all that use it. */
struct mhb_other_pairs {
  const modal_model *model;
  const struct modal_nodal_diameters
      *nodal_diameters;         /* of a disc: its models, the first of which is model; else NULL */
  const modal_joining *joining; /* of the finer one's pairs to the coarser one's */
  bool                 finer;   /* this model is the finer one, and that of the modal file */
};

#endif
