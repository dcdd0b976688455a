/* render/clock.h - wall-clock seconds for statistics. */
#ifndef HL_RENDER_CLOCK_H
#define HL_RENDER_CLOCK_H

double hl_clock_seconds(void);

#endif
