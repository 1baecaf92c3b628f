/* One branch in a response file: the group /branch_i, with its curve under way, its searches, its
 * motion that lasts and its modal amplitudes. */
#ifndef MHB_RESPONSE_BRANCH_FILE_H
#define MHB_RESPONSE_BRANCH_FILE_H

#include "mhb/response/response_types.h"
#include "modal/hdf5/h5.h"

/* Entries of a list of a response file, at most. */
enum { MHB_MOST_ENTRIES = 100000 };

/* Write a branch; the scales of the root exist. SHB_ERR_IO: not written. */
shb_status mhb_branch_write(hid_t file, const mhb_response *response, int index);

/* Append the next branch of a file, whose root has been read. path is for messages. SHB_ERR_INPUT:
 * something is missing or out of its range. */
shb_status mhb_branch_read(hid_t file, const char *path, mhb_response *response);

#endif
