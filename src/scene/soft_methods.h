/* scene/soft_methods.h - gives the list of the methods of soft shadows: the enumerator of each method, and
 * its name in scene files. A method's folder is src/shadow_NAME/, and its table is hl_shadow_NAME
 * (shadow/shadow_method.h). meson.build reads the names in this file. */
/* clang-format off */
#define HL_SOFT_METHODS                     \
  HL_SOFT_METHOD(HL_SOFT_CASCADE, cascade)  \
  HL_SOFT_METHOD(HL_SOFT_PAPER, paper)      \
  HL_SOFT_METHOD(HL_SOFT_SUBLIGHTS, sublights)
