/* Reproducible pseudo-random numbers for start vectors, equal on every machine. */
#ifndef MODAL_COMMON_RANDOM_VECTOR_H
#define MODAL_COMMON_RANDOM_VECTOR_H

#include <stdint.h>

/* A fixed number in [-1, 1) for each key: the finaliser of splitmix64 (Steele, Lea, Flood 2014). A
 * random vector has a component along every mode, symmetric ones included. */
static inline double modal_random(uint64_t key) {
  uint64_t z = (key + 1) * 0x9e3779b97f4a7c15u;
  z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z          = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

#endif
