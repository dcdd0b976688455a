/* cli/sheet_font.h - letters of five by seven dots, and two below the line, for the words under the pictures
 * of a contact sheet. */
#ifndef HL_CLI_SHEET_FONT_H
#define HL_CLI_SHEET_FONT_H

enum { LETTER_WIDTH = 5, LETTER_HEIGHT = 9, LETTER_STEP = 6 };

/* Bit x of row y, top row first; x from the left. Letters that the font lacks are blank. */
void letter_rows(char letter, unsigned char rows[LETTER_HEIGHT]);

#endif
