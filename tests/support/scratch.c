#include "tests/support/scratch.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const char whole[] =
    "name: odd_blade\n"                                                                    /* 1 */
    "mesh:\n"                                                                              /* 2 */
    "  blade:\n"                                                                           /* 3 */
    "    root: {length: 61 mm, width: 43 mm, height: 19 mm}\n"                             /* 4 */
    "    sections:\n"                                                                      /* 5 */
    "      - {radius: 0.31, chord: 53 mm, thickness: 5 mm, camber: 3 mm, twist: 20 deg}\n" /* 6 */
    "      - {radius: 0.47 m, chord: 41 mm, thickness: 2.9 mm}\n"                          /* 7 */
    "    shroud: {length: 37 mm, thickness: 6.1 mm, contact: 23 mm}\n"                     /* 8 */
    "    size: 8 mm\n"                                                                     /* 9 */
    "    shroud_size: 4 mm\n"                                                              /* 10 */
    "material: {E: 207 GPa, nu: 0.29, rho: 7.85 g/cm3}\n"                                  /* 11 */
    "rotor: {blades: 37, speed: 2900 rpm, axis: -y}\n"                                     /* 12 */
    "modal: {modes: 17, damping: 0.23 %}\n"                                                /* 13 */
    "excitation:\n"                                                                        /* 14 */
    "  engine_order: 7\n"                                                                  /* 15 */
    "  pressure: 210 Pa\n"                                                                 /* 16 */
    "  harmonics: {1: [1, 0 deg], 3: [0.21, 90 deg]}\n"                                    /* 17 */
    "probe: {tip: [1 mm, 2 mm, 0.47 m], mid: [0, 0, 0.4]}\n"                               /* 18 */
    "contact:\n"                                                                           /* 19 */
    "  to: neighbour\n"                                                                    /* 20 */
    "  psi: 35 deg\n"                                                                      /* 21 */
    "  phi: -3 deg\n"                                                                      /* 22 */
    "  points: 4\n"                                                                        /* 23 */
    "  mu: 0.31\n"                                                                         /* 24 */
    "  ku: [0.5 MN/m, -70 kN/m, 0.6 MN/m]\n"                                               /* 25 */
    "  kv: 0.8 MN/m\n"                                                                     /* 26 */
    "  n0: [-20 N, 0, 0.3 kN]\n"                                                           /* 27 */
    "  preload: interference\n"                                                            /* 28 */
    "  accuracy: 2e-9\n"                                                                   /* 29 */
    "mhb:\n"                                                                               /* 30 */
    "  frequency: [90 Hz, 0.12 kHz]\n"                                                     /* 31 */
    "  harmonics: 7\n"                                                                     /* 32 */
    "  subharmonics: 2\n"                                                                  /* 33 */
    "  scale: 1.3\n"                                                                       /* 34 */
    "  max_points: 777\n"                                                                  /* 35 */
    "  stability: always\n";                                                               /* 36 */

void scratch_create(char folder[SCRATCH_PATH]) {
  const char *base = getenv("TMPDIR");
  snprintf(folder, SCRATCH_PATH, "%s/shroudhb-test-XXXXXX", base && base[0] ? base : "/tmp");
  assert_non_null(mkdtemp(folder));
}

static void join(char path[2 * SCRATCH_PATH], const char *folder, const char *name) {
  snprintf(path, 2 * SCRATCH_PATH, "%s/%s", folder, name);
}

void scratch_write(const char *folder, const char *name, const char *text, size_t n) {
  char path[2 * SCRATCH_PATH];
  join(path, folder, name);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, n, file), n);
  assert_int_equal(fclose(file), 0);
}

void scratch_remove(const char *folder) {
  DIR *dir = opendir(folder);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
    char path[2 * SCRATCH_PATH];
    join(path, folder, entry->d_name);
    unlink(path); /* refuses . and .. */
  }
  closedir(dir);
  assert_int_equal(rmdir(folder), 0);
}

char *scratch_case(const char *from, const char *to) {
  size_t size = sizeof whole + (to ? strlen(to) : 0);
  char  *text = malloc(size);
  assert_non_null(text);
  const char *at = from ? strstr(whole, from) : NULL;
  assert_true(!from || at);
  if (from) {
    snprintf(text, size, "%.*s%s%s", (int)(at - whole), whole, to, at + strlen(from));
  } else {
    snprintf(text, size, "%s", whole);
  }
  return text;
}
