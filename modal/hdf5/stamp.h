/* The stamp of a file: 512 bytes before the HDF5 superblock with the length and a checksum of what
 * follows. HDF5 finds its superblock at 512 bytes too, so every reader of HDF5 skips the stamp.
 *
 * A change within eight bytes is found for certain, any other change but for a chance of 2^-64. */
#ifndef MODAL_HDF5_STAMP_H
#define MODAL_HDF5_STAMP_H

#include <stddef.h>

enum { H5_STAMP = 512 };

typedef enum {
  H5_UNSTAMPED, /* of another program, or of an earlier version */
  H5_INTACT,
  H5_CHANGED,   /* damaged, or edited by another program */
  H5_SHORT,     /* the file ends early */
  H5_UNREADABLE /* there is no file, or the system does not let it be read: errno */
} h5_stamp_state;

void h5_stamp_make(const void *image, size_t size, char stamp[H5_STAMP]);

h5_stamp_state h5_stamp_check(const char *path);

#endif
