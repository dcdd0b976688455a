/* cli/sheet_font.h - defines the letters for the words under the pictures of a contact sheet. A letter has
 * five by seven dots, and two rows of dots below its line. */
#ifndef HL_CLI_SHEET_FONT_H
#define HL_CLI_SHEET_FONT_H

enum { LETTER_WIDTH = 5, LETTER_HEIGHT = 9, LETTER_STEP = 6 };

/* Bit x of row y, top row first; x from the left. Letters that the font lacks are blank. */
void letter_rows(char letter, unsigned char rows[LETTER_HEIGHT]);

#endif
