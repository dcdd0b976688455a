/* platform/windows/include/dirent.h - declares the functions of POSIX's <dirent.h>, which work with a
 * folder's handle. */
#ifndef HL_PLATFORM_WINDOWS_DIRENT_H
#define HL_PLATFORM_WINDOWS_DIRENT_H

typedef struct hl_folder_listing DIR;

struct dirent {
  char d_name[768]; /* the file's name in UTF-8 */
};

DIR *opendir(const char *path);
DIR *fdopendir(int descriptor);
struct dirent *readdir(DIR *folder);
int closedir(DIR *folder);
int dirfd(DIR *folder);

#endif
