#include "modal/hdf5/stamp.h"

#include <endian.h>
#include <errno.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const char title[] = "shroudhb file";

enum { BLOCK = 1 << 16 }; /* a multiple of 8; on the stack, so that memory cannot fail */

/* One-to-one in both arguments, so that two different words give two different sums. */
static uint64_t add_word(uint64_t sum, uint64_t word) {
  sum = (sum ^ word) * 0x9e3779b97f4a7c15u;
  return sum ^ (sum >> 32);
}

/* Words of eight bytes, the last one padded with zeros. */
static uint64_t add_bytes(uint64_t sum, const unsigned char *data, size_t size) {
  for (size_t i = 0; i < size; i += 8) {
    uint64_t word = 0;
    memcpy(&word, data + i, size - i < 8 ? size - i : 8);
    sum = add_word(sum, le64toh(word));
  }
  return sum;
}

void h5_stamp_make(const void *image, size_t size, char stamp[H5_STAMP]) {
  const uint64_t sum = add_word(add_bytes(0, image, size), size);
  memset(stamp, ' ', H5_STAMP);
  const int n         = snprintf(stamp, H5_STAMP,
                                 "%s\nlength %zu\nchecksum %016" PRIx64
                                 "\nof what follows these 512 bytes, an HDF5 file\n",
                                 title, size, sum);
  stamp[n]            = ' ';
  stamp[H5_STAMP - 1] = '\n';
}

static bool read_stamp(FILE *file, size_t *length, uint64_t *sum) {
  char text[H5_STAMP + 1] = "";
  return fread(text, 1, H5_STAMP, file) == H5_STAMP &&
         strncmp(text, title, sizeof title - 1) == 0 &&
         sscanf(text + sizeof title - 1, " length %zu checksum %" SCNx64, length, sum) == 2;
}

static h5_stamp_state check(FILE *file) {
  size_t        length, found = 0;
  uint64_t      wanted, sum   = 0;
  unsigned char block[BLOCK];
  const bool    stamped = read_stamp(file, &length, &wanted);
  if (ferror(file)) return H5_UNREADABLE;
  if (!stamped) return H5_UNSTAMPED;
  for (size_t n; (n = fread(block, 1, BLOCK, file)) > 0; found += n) sum = add_bytes(sum, block, n);
  if (ferror(file)) return H5_UNREADABLE;
  if (found < length) return H5_SHORT;
  return found == length && add_word(sum, length) == wanted ? H5_INTACT : H5_CHANGED;
}

h5_stamp_state h5_stamp_check(const char *path) {
  FILE *file = fopen(path, "rb");
  if (!file) return H5_UNREADABLE;
  const h5_stamp_state state = check(file);
  const int            why   = errno;
  fclose(file);
  errno = why;
  return state;
}
