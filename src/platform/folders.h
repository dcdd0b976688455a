/* platform/folders.h - makes folders that a program keeps for its user. */
#ifndef HL_PLATFORM_FOLDERS_H
#define HL_PLATFORM_FOLDERS_H

/* Makes a folder that only its user may enter, and the folders above it that are missing. The caller opens
 * the folder, or a file in it, to find out whether the folder exists. path: an absolute path. */
void hl_private_folder_make(const char *path);

#endif
