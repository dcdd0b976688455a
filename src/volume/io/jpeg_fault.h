/* volume/io/jpeg_fault.h - converts an error of libjpeg to a longjmp() with a message. Only builds with
 * libjpeg include this file. */
#ifndef HL_VOLUME_JPEG_FAULT_H
#define HL_VOLUME_JPEG_FAULT_H

#include <setjmp.h>
#include <stdio.h>

#include <jpeglib.h>

typedef struct hl_jpeg_fault {
  struct jpeg_error_mgr manager; /* libjpeg's error manager, to which the decoder's `err` points */
  jmp_buf jump;                  /* the place at which execution continues after an error */
  char message[JMSG_LENGTH_MAX]; /* the error's message, set before the jump */
} hl_jpeg_fault;

static inline void hl_jpeg_stop(j_common_ptr info) {
  hl_jpeg_fault *fault = (hl_jpeg_fault *)(void *)info->err;
  info->err->format_message(info, fault->message);
  longjmp(fault->jump, 1);
}

static inline void hl_jpeg_pass_over(j_common_ptr info) { (void)info; }

/* Makes the decoder jump to `jump` after an error. The caller must have set `jump` by setjmp(). Warnings are
 * ignored. */
static inline void hl_jpeg_catch(struct jpeg_decompress_struct *info, hl_jpeg_fault *fault) {
  info->err = jpeg_std_error(&fault->manager);
  fault->manager.error_exit = hl_jpeg_stop;
  fault->manager.output_message = hl_jpeg_pass_over;
}

#endif
