/* volume/io/lengths.c - finds the length of a unit that a microscope's file names. The symbols are taken from
 * OME's schema (UnitsLength) and the International System of Units. The names are taken from UDUNITS-2 and
 * ImageJ. */
#include "volume/io/lengths.h"

#include <stddef.h>
#include <string.h>

#include "volume/io/text.h"

double hl_micrometres(const char *unit) {
  static const struct {
    const char *symbol;
    double micrometres;
  } symbols[] = {{"Ym", 1e30},
                 {"Zm", 1e27},
                 {"Em", 1e24},
                 {"Pm", 1e21},
                 {"Tm", 1e18},
                 {"Gm", 1e15},
                 {"Mm", 1e12},
                 {"km", 1e9},
                 {"hm", 1e8},
                 {"dam", 1e7},
                 {"m", 1e6},
                 {"dm", 1e5},
                 {"cm", 1e4},
                 {"mm", 1e3},
                 {"\xc2\xb5m", 1},
                 {"\xce\xbcm", 1},
                 {"\xb5m", 1},
                 {"\\u00B5m", 1},
                 {"\\u00b5m", 1},
                 {"um", 1},
                 {"nm", 1e-3},
                 {"pm", 1e-6},
                 {"fm", 1e-9},
                 {"am", 1e-12},
                 {"zm", 1e-15},
                 {"ym", 1e-18},
                 {"\xc3\x85", 1e-4},
                 {"\xe2\x84\xab", 1e-4},
                 {"A", 1e-4},
                 {"thou", 25.4},
                 {"li", 25400.0 / 12},
                 {"in", 25400},
                 {"ft", 304800},
                 {"yd", 914400},
                 {"mi", 1609344e3},
                 {"ua", 149597870700e6},
                 {"ly", 9460730472580800e6},
                 {"pc", 3.0856775814913673e22},
                 {"pt", 25400.0 / 72}};
  static const struct {
    const char *names; /* names in letters of either case */
    double micrometres;
  } names[] = {{"angstrom", 1e-4},
               {"picometer|picometre", 1e-6},
               {"nanometer|nanometre", 1e-3},
               {"micrometer|micrometre|micron|microns|micrometers", 1},
               {"millimeter|millimetre", 1e3},
               {"centimeter|centimetre", 1e4},
               {"decimeter|decimetre", 1e5},
               {"meter|metre", 1e6},
               {"kilometer|kilometre", 1e9},
               {"inch|inches", 25400},
               {"foot", 304800},
               {"yard", 914400},
               {"mile", 1609344e3},
               {"parsec", 3.0856775814913673e22}};
  for (size_t n = 0; unit != NULL && n < sizeof symbols / sizeof *symbols; n++)
    if (strcmp(unit, symbols[n].symbol) == 0) return symbols[n].micrometres;
  for (size_t n = 0; unit != NULL && n < sizeof names / sizeof *names; n++)
    if (hl_text_is_one_of(unit, names[n].names)) return names[n].micrometres;
  return 0;
}
