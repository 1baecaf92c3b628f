/* A library for LD_PRELOAD that takes the locale of the user, as some do when they start. */
#include <locale.h>

__attribute__((constructor)) static void take_locale(void) {
  setlocale(LC_ALL, "");
}
