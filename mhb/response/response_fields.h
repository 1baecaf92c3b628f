/* The arrays of a branch of the response: one table that drives growing, writing and reading. */
#ifndef MHB_RESPONSE_RESPONSE_FIELDS_H
#define MHB_RESPONSE_RESPONSE_FIELDS_H

#include <stddef.h>

#include "mhb/response/response.h"
#include "modal/hdf5/h5.h"

typedef enum { MHB_DOUBLE, MHB_COMPLEX, MHB_INT } mhb_number;

/* dims: the dimensions after [point], one letter each: p pair, q probe, 3 shroud axes, x cylindrical axes, s contact state,
 *  k harmonic 0..m, f multiplier, l spectral line, i contact interface (none where there is one). */
typedef struct {
  const char *name, *dims;
  mhb_number  kind;
  size_t      offset; /* of the pointer in mhb_branch */
  const char *units;  /* NULL: of the parameter that is followed */
  const char *long_name;
} mhb_field;

enum { MHB_N_FIELDS = 27 };
extern const mhb_field mhb_fields[MHB_N_FIELDS]; /* the first: the frequency */

size_t   mhb_field_bytes(mhb_number kind);
h5_shape mhb_field_shape(const mhb_response *response, const mhb_branch *branch, const mhb_field *f,
                         int n_points);

/* Values a point. */
size_t mhb_field_width(const mhb_response *response, const mhb_branch *branch, const mhb_field *f);

/* Which kind of branch alone has a field; MHB_N_BRANCH_KINDS: all. */
mhb_branch_kind mhb_field_owner(const mhb_field *f);

/* Without probes there is no probe array, in memory or in the file. */
bool mhb_field_kept(const mhb_response *response, const mhb_branch *branch, const mhb_field *f);

/* The followed parameter where it is the frequency: not in the file twice. */
bool mhb_field_is_frequency(const mhb_response *response, const mhb_field *f);

void *mhb_field_get(const mhb_branch *branch, const mhb_field *f);
void  mhb_field_set(mhb_branch *branch, const mhb_field *f, void *data);

#endif
