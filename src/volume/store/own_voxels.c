/* volume/store/own_voxels.c - see own_voxels.h. */
#include "volume/store/own_voxels.h"

#include <string.h>

#include "core/memory.h"

/* The type of stored values in each kind of hl_storage. */
static const hl_voxel_type stored_types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};

static hl_status make(hl_ranks *ranks, hl_own_voxels **own, hl_error *error) {
  *own = hl_allocate_zeroed(ranks->context, 1, sizeof **own);
  if (*own == NULL) return hl_fail_memory(error, sizeof **own, "a rank's voxels");
  (*own)->context = ranks->context;
  pthread_mutex_init(&(*own)->row_lock, NULL);
  return HL_OK;
}

static void pack_strides(hl_own_voxels *own, size_t bytes, const size_t n[3]) {
  own->stride[0] = (ptrdiff_t)bytes;
  own->stride[1] = own->stride[0] * (ptrdiff_t)n[0];
  own->stride[2] = own->stride[1] * (ptrdiff_t)n[1];
}

/* Allocates the slices of a block whose box and type are set. Releases the block on failure. */
static hl_status allocate_slices(hl_own_voxels **own, hl_error *error) {
  hl_own_voxels *made = *own;
  const uint64_t *n = made->box.count;
  size_t count = hl_own_voxels_count(made), bytes = made->stored_bytes;
  pack_strides(made, bytes, (const size_t[3]){n[0], n[1], n[2]});
  made->first = made->slices = hl_allocate(made->context, count, bytes);
  if (made->slices != NULL) return HL_OK;
  hl_own_voxels_release(made);
  *own = NULL;
  return hl_fail_memory(error, count * bytes, "a rank's share of a volume");
}

hl_status hl_own_voxels_allocate(hl_ranks *ranks, const hl_volume_description *whole, hl_own_voxels **own,
                                 hl_error *error) {
  hl_status status = make(ranks, own, error);
  if (status != HL_OK) return status;
  hl_own_voxels *made = *own;
  const size_t *n = whole->dimensions;
  hl_storage storage = hl_voxel_type_storage(whole->type);
  made->type = made->stored = stored_types[storage];
  made->stored_bytes = hl_storage_bytes(storage);
  made->box.begin[2] = hl_ranks_part(ranks, n[2], ranks->rank);
  made->box.count[0] = n[0];
  made->box.count[1] = n[1];
  made->box.count[2] = hl_ranks_part(ranks, n[2], ranks->rank + 1) - made->box.begin[2];
  return allocate_slices(own, error);
}

hl_status hl_own_voxels_like(hl_ranks *ranks, const hl_own_voxels *other, hl_own_voxels **own,
                             hl_error *error) {
  hl_status status = make(ranks, own, error);
  if (status != HL_OK) return status;
  (*own)->type = (*own)->stored = HL_VOXEL_F32;
  (*own)->stored_bytes = sizeof(float);
  (*own)->box = other->box;
  return allocate_slices(own, error);
}

hl_status hl_own_voxels_borrow(hl_ranks *ranks, const hl_volume_description *whole, const hl_block *block,
                               hl_own_voxels **own, hl_error *error) {
  hl_status status = make(ranks, own, error);
  if (status != HL_OK) return status;
  hl_own_voxels *made = *own;
  const ptrdiff_t *given = block->stride_bytes;
  size_t bytes = hl_voxel_type_bytes(whole->type), around[3];
  made->type = whole->type;
  made->stored = stored_types[hl_voxel_type_storage(whole->type)];
  made->stored_bytes = hl_storage_bytes(hl_voxel_type_storage(whole->type));
  made->first = block->voxels;
  for (int a = 0; a < 3; a++) {
    made->box.begin[a] = block->offset[a];
    made->box.count[a] = block->size[a];
    around[a] = block->size[a] + 2 * block->ghost[a];
  }
  pack_strides(made, bytes, around);
  if (given[0] != 0 || given[1] != 0 || given[2] != 0) memcpy(made->stride, given, sizeof made->stride);
  for (int a = 0; a < 3 && hl_own_voxels_count(made) > 0; a++)
    made->first += (ptrdiff_t)block->ghost[a] * made->stride[a];
  if (made->stride[0] == (ptrdiff_t)bytes) return HL_OK;
  if ((made->row = hl_allocate(ranks->context, block->size[0], bytes)) != NULL) return HL_OK;
  hl_own_voxels_release(made);
  *own = NULL;
  return hl_fail_memory(error, block->size[0] * bytes, "a row of a rank's voxels");
}

void hl_own_voxels_release(hl_own_voxels *own) {
  if (own == NULL) return;
  pthread_mutex_destroy(&own->row_lock);
  hl_release(own->context, own->slices);
  hl_release(own->context, own->exact);
  hl_release(own->context, own->row);
  hl_release(own->context, own);
}

/* Copies `count` adjacent voxels of a row as stored values. */
static void copy_row(const hl_own_voxels *own, const unsigned char *from, size_t count, unsigned char *to) {
  if (own->row != NULL) {
    hl_voxels_gather(from, own->stride[0], hl_voxel_type_bytes(own->type), count, own->row);
    from = own->row;
  }
  hl_voxels_store(own->type, false, from, count, to);
}

void hl_own_voxels_copy(const void *data, const hl_box *box, unsigned char *to) {
  const hl_own_voxels *own = data;
  size_t row_bytes = box->count[0] * own->stored_bytes;
  pthread_mutex_t *lock = (pthread_mutex_t *)&own->row_lock;
  if (own->row != NULL) pthread_mutex_lock(lock);
  for (uint64_t k = 0; k < box->count[2]; k++)
    for (uint64_t j = 0; j < box->count[1]; j++, to += row_bytes) {
      const ptrdiff_t at[3] = {(ptrdiff_t)(box->begin[0] - own->box.begin[0]),
                               (ptrdiff_t)(box->begin[1] + j - own->box.begin[1]),
                               (ptrdiff_t)(box->begin[2] + k - own->box.begin[2])};
      copy_row(own, own->first + at[0] * own->stride[0] + at[1] * own->stride[1] + at[2] * own->stride[2],
               box->count[0], to);
    }
  if (own->row != NULL) pthread_mutex_unlock(lock);
}

void hl_own_voxels_run(const hl_own_voxels *own, size_t first, size_t count, unsigned char *to) {
  const uint64_t *n = own->box.count, *begin = own->box.begin;
  for (size_t done = 0; done < count;) {
    size_t row = (first + done) / n[0], i = (first + done) % n[0];
    size_t taken = n[0] - i < count - done ? n[0] - i : count - done;
    const hl_box part = {{begin[0] + i, begin[1] + row % n[1], begin[2] + row / n[1]}, {taken, 1, 1}};
    hl_own_voxels_copy(own, &part, to + done * own->stored_bytes);
    done += taken;
  }
}
