/* Shared by the h5*.c files only: HDF5 types and texts of failures. */
#ifndef MODAL_HDF5_H5_INTERNAL_H
#define MODAL_HDF5_H5_INTERNAL_H

#include "modal/hdf5/h5.h"

enum { H5_LABEL = 1024 };

/* Text "FILE: /group/path" for messages, without the suffix of an unpublished file. Returns out. */
const char *h5_label(hid_t at, const char *path, char out[H5_LABEL]);

/* Record "FILE: /path verb: innermost HDF5 error". Call it before any other HDF5 call, since each
 * call clears the error stack. */
shb_status h5_failed(shb_status code, hid_t at, const char *path, const char *verb);

/* Innermost text of HDF5's error stack, at most size characters. */
void h5_reason(char *out, size_t size);

/* Text such as "[2, 3, any]"; zeros read "any" where wanted is true. Returns out. */
const char *h5_shape_text(h5_shape shape, bool wanted, char out[128]);

/* SHB_ERR_INPUT if a value is infinite or not a number. The text names its place.
 *   per   in  doubles of a value, 2 for complex ones
 *   rule  in  ends the text */
shb_status h5_check_finite(const char *label, h5_shape shape, const double *data, size_t per,
                           const char *rule);

/* SHB_ERR_INPUT if a dataset or link of an open file leads to another file: external storage, a
 * virtual dataset, an external link. Such content is not the file's own, may be private, and is
 * behind no checksum. Nothing of it is opened. The same if an object cannot be read. */
shb_status h5_check_content(const char *path, hid_t file);

/* Compound of two native doubles (member names differ between writers); variable-length UTF-8 text.
 * The caller closes the type. */
hid_t h5_complex_type(const char *real, const char *imaginary);
hid_t h5_text_type(void);

#endif
