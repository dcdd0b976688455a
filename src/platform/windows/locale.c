/* platform/windows/locale.c - sets the locale "C" for a thread (platform/windows/include/locale.h). */
#include <locale.h>
#include <stdlib.h>
#include <string.h>

/* The object that uselocale() returns. A later call of uselocale() with this object restores the thread's
 * previous locale. */
typedef struct kept_locale {
  int mode; /* whether the thread had a locale of its own */
  char name[];
} kept_locale;

static char the_locale; /* the address of this variable stands for the locale "C" */
/* The function uselocale() returns the address of this variable if the call changed nothing, because the
 * thread had the locale "C" already, or because memory was short. */
static char no_change;

locale_t newlocale(int mask, const char *name, locale_t base) {
  (void)mask, (void)name, (void)base;
  return &the_locale;
}

static locale_t enter(void) {
  const char *name = setlocale(LC_ALL, NULL);
  if (name == NULL || strcmp(name, "C") == 0) return &no_change;
  kept_locale *kept = malloc(sizeof *kept + strlen(name) + 1);
  if (kept == NULL) return &no_change;
  strcpy(kept->name, name);
  kept->mode = _configthreadlocale(_ENABLE_PER_THREAD_LOCALE);
  setlocale(LC_ALL, "C");
  return kept;
}

locale_t uselocale(locale_t locale) {
  if (locale == &the_locale) return enter();
  if (locale == &no_change) return &the_locale;
  kept_locale *kept = locale;
  setlocale(LC_ALL, kept->name);
  if (kept->mode == _DISABLE_PER_THREAD_LOCALE) _configthreadlocale(_DISABLE_PER_THREAD_LOCALE);
  free(kept);
  return &the_locale;
}

double strtod_l(const char *text, char **end, locale_t locale) {
  locale_t before = uselocale(locale);
  double number = strtod(text, end);
  uselocale(before);
  return number;
}
