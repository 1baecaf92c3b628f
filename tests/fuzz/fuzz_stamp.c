/* The checksum before an HDF5 file: it fits what was stamped, and no change of it. */
#include <stdlib.h>
#include <string.h>

#include "modal/hdf5/stamp.h"
#include "tests/fuzz/fuzz_file.h"

static h5_stamp_state state_of(const void *data, size_t size) {
  return h5_stamp_check(fuzz_text("result.h5", data, size));
}

/* The first four bytes choose where a stamped file is changed, and how. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (size < 5 || size > FUZZ_MOST) return 0;
  state_of(data + 4, size - 4); /* any file at all */
  size_t image = size - 4, whole = image + H5_STAMP;
  char  *file = malloc(whole);
  if (!file) return 0;
  memcpy(file + H5_STAMP, data + 4, image);
  h5_stamp_make(data + 4, image, file);
  fuzz_assert(state_of(file, whole) == H5_INTACT, "a file does not fit its stamp");
  size_t  at     = H5_STAMP + (data[0] | (size_t)data[1] << 8 | (size_t)data[2] << 16) % image;
  uint8_t change = data[3] ? data[3] : 1;
  file[at]       = (char)(file[at] ^ change);
  fuzz_assert(state_of(file, whole) == H5_CHANGED, "a changed file fits its stamp");
  file[at] = (char)(file[at] ^ change);
  fuzz_assert(state_of(file, at) == H5_SHORT, "a file that ends early is not seen");
  free(file);
  return 0;
}
