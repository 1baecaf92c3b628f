/* The arrays of a branch of the response: one table for growing, writing and reading. */
#ifndef MHB_RESPONSE_RESPONSE_FIELDS_H
#define MHB_RESPONSE_RESPONSE_FIELDS_H

#include <stddef.h>

#include "mhb/response/response_types.h"
#include "modal/hdf5/h5.h"

typedef enum { MHB_DOUBLE, MHB_COMPLEX, MHB_INT } mhb_number;

/* A dataset of a branch. dims has one letter for each dimension after [point]:
 *
 *   p  pair           q  probe             i  contact interface   s  contact state
 *   3  shroud axes    x  cylindrical axes  k  harmonic 0..m       f  multiplier
 *   l  spectral line */
typedef struct {
  const char *name, *dims;
  mhb_number  kind;
  size_t      offset; /* of the pointer in mhb_branch */
  const char *units;  /* NULL: those of the parameter followed */
  const char *long_name;
} mhb_field;

enum { MHB_N_FIELDS = 49 };
extern const mhb_field mhb_fields[MHB_N_FIELDS]; /* the first is the frequency */

/* Bytes of a number. */
size_t mhb_field_bytes(mhb_number kind);

/* Shape in the file. */
h5_shape mhb_field_shape(const mhb_response *response, const mhb_branch *branch, const mhb_field *f,
                         int n_points);

/* Bytes a point. */
size_t mhb_field_row(const mhb_response *response, const mhb_branch *branch, const mhb_field *f);

/* Kind of branch that alone has the field; MHB_N_BRANCH_KINDS: all have it. */
mhb_branch_kind mhb_field_owner(const mhb_field *f);

/* Files of earlier versions may lack the field: it is not known then. */
bool mhb_field_is_later(const mhb_field *f);

/* The branch has the field, in memory and in the file: its kind does, and its width is not 0. */
bool mhb_field_kept(const mhb_response *response, const mhb_branch *branch, const mhb_field *f);

/* The parameter followed is the frequency: it is not in the file twice. */
bool mhb_field_is_frequency(const mhb_response *response, const mhb_field *f);

/* The array of a branch. */
void *mhb_field_get(const mhb_branch *branch, const mhb_field *f);
void  mhb_field_set(mhb_branch *branch, const mhb_field *f, void *data);

#endif
