/* gpu/kernels/dialect.h - defines the dialect of the kernels: macros that hide the differences between OpenCL
 * C 1.2, CUDA C++ and C17.
 *
 * Every float operation is one IEEE operation, rounded to nearest. A product and a sum are fused only by the
 * function fused(). So the kernels give the same bytes as the processor's functions (simd/lanes.h), which do
 * the same operations in the same order. */
#ifndef HL_GPU_DIALECT_H
#define HL_GPU_DIALECT_H

/* Number of members of a group, and number of groups of a tile of 256 pixels. */
#define GROUP       64
#define TILE_GROUPS (256 / GROUP)

#if defined(__OPENCL_VERSION__)

#pragma OPENCL FP_CONTRACT OFF
#define GLOBAL __global
/* Marks a pointer to memory that the kernel accesses through no other pointer. */
#define APART       restrict
#define DEVICE      static
#define DEVICE_CALL static
/* Marks a function as a kernel. groups: the least number of groups that an NVIDIA multiprocessor shall hold
 * at once, which limits the registers of each member. */
#define KERNEL(groups) __kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void
typedef uchar byte;
typedef ushort word16;
typedef ulong wide;
#define fused(a, b, c)  fma((float)(a), (float)(b), (float)(c))
#define divided(a, b)   ((float)(a) / (float)(b))
#define root(x)         sqrt((float)(x))
#define bits_of(x)      as_int((float)(x))
#define of_bits(x)      as_float((int)(x))
#define add_to(at, x)   atomic_add(at, x)
#define or_to(at, x)    atomic_or(at, x)
#define group_number()  ((int)get_group_id(0))
#define member_number() ((int)get_local_id(0))
#define work_number()   ((int)get_global_id(0))
#define work_count()    ((unsigned)get_global_size(0))
/* A pack is a set of members that step together. least_of_pack() gives the least of the members' numbers, and
 * any_of_pack() tells whether a condition holds for any of its members. In OpenCL a pack is a single member.
 * If all members of a group must take the same steps, the steps have the length one. */
#define least_of_pack(value)   (value)
#define any_of_pack(condition) (condition)
#define least_of_group(value)  1
#define SHARED_VOTES           __local int votes[GROUP / 16]
#define UNROLLED
/* Returns whether a condition holds for any of the sixteen pixels of the member's block. All members of the
 * group must call it. votes: memory that the group shares, with one vote for each block. */
#define block_any(votes, condition)                                                               \
  (barrier(CLK_LOCAL_MEM_FENCE),                                                                  \
   (get_local_id(0) & 15) == 0 ? (void)(votes[get_local_id(0) >> 4] = 0) : (void)0,               \
   barrier(CLK_LOCAL_MEM_FENCE), (condition) ? (void)(votes[get_local_id(0) >> 4] = 1) : (void)0, \
   barrier(CLK_LOCAL_MEM_FENCE), votes[get_local_id(0) >> 4])

#elif defined(__CUDACC_RTC__) || defined(__CUDACC__)

#define GLOBAL
#define APART                  __restrict__
#define DEVICE                 static __device__ __forceinline__
#define DEVICE_CALL            static __device__ __noinline__
#define KERNEL(groups)         extern "C" __global__ void __launch_bounds__(GROUP, groups)
typedef unsigned char byte;
typedef unsigned short word16;
typedef unsigned long long wide;
#define fused(a, b, c)         __fmaf_rn(a, b, c)
#define divided(a, b)          __fdiv_rn(a, b)
#define root(x)                __fsqrt_rn(x)
#define bits_of(x)             __float_as_int(x)
#define of_bits(x)             __int_as_float(x)
#define add_to(at, x)          atomicAdd(at, x)
#define or_to(at, x)           atomicOr(at, x)
#define group_number()         ((int)blockIdx.x)
#define member_number()        ((int)threadIdx.x)
#define work_number()          ((int)(blockIdx.x * blockDim.x + threadIdx.x))
#define work_count()           (gridDim.x * blockDim.x)
/* the members of a warp step together */
#define least_of_pack(value)   __reduce_min_sync(__activemask(), value)
#define any_of_pack(condition) (__any_sync(__activemask(), condition) != 0)
#define least_of_group(value)  __reduce_min_sync(0xffffffffu, value)
#define SHARED_VOTES           int votes = 0
#define UNROLLED               _Pragma("unroll")
/* A block is half of a warp. */
#define block_any(votes, condition) \
  ((votes = (int)(__ballot_sync(0xffffffffu, condition) >> (threadIdx.x & 16) & 0xffffu)) != 0)

#else /* C17, for unit tests */

#define UNROLLED
#include <math.h>
#include <stdint.h>
#include <string.h>
#define GLOBAL
#define DEVICE         static inline __attribute__((unused))
#define DEVICE_CALL    static __attribute__((unused))
typedef unsigned char byte;
typedef uint16_t word16;
typedef uint64_t wide;
#define fused(a, b, c) fmaf(a, b, c)
#define divided(a, b)  ((a) / (b))
#define root(x)        sqrtf(x)
DEVICE int bits_of(float x) {
  int bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}
DEVICE float of_bits(int bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

#endif

#endif
