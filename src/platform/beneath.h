/* platform/beneath.h - opens files below a folder. Neither a file's name nor a link can lead out of the
 * folder. */
#ifndef HL_PLATFORM_BENEATH_H
#define HL_PLATFORM_BENEATH_H

/* Opens the file `name` relative to a folder's descriptor, with the flags of open(). Returns the file's
 * descriptor, or -1 and sets errno. The name "" stands for the folder itself. Absolute names are refused, and
 * so are names and links that lead out of the folder, whether or not such a file exists. The descriptor is
 * closed on exec. */
int hl_beneath_open(int folder, const char *name, int flags);

/* Opens a file like hl_beneath_open(), on systems without openat2(). The function follows no symbolic links,
 * and refuses "..". */
int hl_beneath_open_by_components(int folder, const char *name, int flags);

#endif
