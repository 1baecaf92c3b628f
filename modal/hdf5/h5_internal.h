/* Shared by the h5_*.c files only: types on disk and texts of failures. */
#ifndef MODAL_HDF5_H5_INTERNAL_H
#define MODAL_HDF5_H5_INTERNAL_H

#include "modal/hdf5/h5.h"

enum { H5_LABEL = 1024 };

/* "FILE: /group/path" for messages; the suffix of an unpublished temporary is left off. Returns out. */
const char *h5_label(hid_t at, const char *path, char out[H5_LABEL]);

/* Record "FILE: /path verb: innermost HDF5 error". Call before any other HDF5 call: each clears the error stack. */
shb_status h5_failed(shb_status code, hid_t at, const char *path, const char *verb);

/* Innermost text of HDF5's error stack, at most size characters. */
void h5_reason(char *out, size_t size);

/* Compound {r, i} of native doubles (names differ between writers); variable-length UTF-8. Caller closes. */
hid_t h5_complex_type(const char *real, const char *imaginary);
hid_t h5_text_type(void);

#endif
