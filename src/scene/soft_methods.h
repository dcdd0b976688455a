/* scene/soft_methods.h - the registry of methods of soft shadows: the enumerator, and the name that scene
 * files use. A method's folder is src/shadow_NAME/, its table hl_shadow_NAME (shadow/shadow_method.h).
 * meson.build reads the names here.
 */
/* clang-format off */
#define HL_SOFT_METHODS                     \
  HL_SOFT_METHOD(HL_SOFT_CASCADE, cascade)  \
  HL_SOFT_METHOD(HL_SOFT_PAPER, paper)      \
  HL_SOFT_METHOD(HL_SOFT_SUBLIGHTS, sublights)
