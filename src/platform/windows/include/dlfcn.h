/* platform/windows/include/dlfcn.h - declares the functions of POSIX's <dlfcn.h> for libraries in the
 * system's own folder. */
#ifndef HL_PLATFORM_WINDOWS_DLFCN_H
#define HL_PLATFORM_WINDOWS_DLFCN_H

enum { RTLD_LOCAL = 0, RTLD_NOW = 2, RTLD_NOLOAD = 4, RTLD_GLOBAL = 8 };

/* Loads a library from the system's own folder. */
void *dlopen(const char *name, int flags);
void *dlsym(void *library, const char *name);
int dlclose(void *library);
const char *dlerror(void);

#endif
