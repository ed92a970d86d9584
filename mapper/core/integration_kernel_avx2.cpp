// Fusion of a frame into a block, one row of eight voxels at a time in AVX2 registers. Compiled
// with -mavx2; called only where the processor has it. Operation for operation as the portable
// version.

#include <immintrin.h>

#include "mapper/core/integration_kernel.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kSide = 8;
constexpr float kScale = 32767.0F;  // kDistanceScale

/// The frame's numbers in every lane.
struct Lanes {
  explicit Lanes(const KernelFrame& frame)
      : fx(_mm256_set1_ps(frame.fx)),
        fy(_mm256_set1_ps(frame.fy)),
        cx_plus_half(_mm256_set1_ps(frame.cx_plus_half)),
        cy_plus_half(_mm256_set1_ps(frame.cy_plus_half)),
        width(_mm256_set1_ps(static_cast<float>(frame.width))),
        height(_mm256_set1_ps(static_cast<float>(frame.height))),
        stride(_mm256_set1_epi32(frame.width)),
        min_depth(_mm256_set1_ps(frame.min_depth_m)),
        max_depth(_mm256_set1_ps(frame.max_depth_m)),
        truncation(_mm256_set1_ps(frame.truncation_m)),
        inverse_truncation(_mm256_set1_ps(frame.inverse_truncation)),
        max_weight(_mm256_set1_ps(frame.max_weight)),
        max_color_weight(_mm256_set1_ps(frame.max_color_weight)) {
    const __m256 steps = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    for (int i = 0; i < 3; ++i)
      along_x[i] = _mm256_mul_ps(steps, _mm256_set1_ps(frame.step_C[0][i]));
  }
  __m256 fx, fy, cx_plus_half, cy_plus_half, width, height;
  __m256i stride;
  __m256 min_depth, max_depth, truncation, inverse_truncation, max_weight, max_color_weight;
  __m256 along_x[3];  ///< from the row's first voxel to each of its voxels, metres in C
};

__m256 both(__m256 a, __m256 b) { return _mm256_and_ps(a, b); }
__m256i choose(__m256 mask, __m256i yes, __m256i no) {
  return _mm256_blendv_epi8(no, yes, _mm256_castps_si256(mask));
}
bool none(__m256 mask) { return _mm256_testz_ps(mask, mask) != 0; }

__m256 is_within(__m256 value, __m256 end) {
  return both(_mm256_cmp_ps(value, _mm256_setzero_ps(), _CMP_GE_OQ),
              _mm256_cmp_ps(value, end, _CMP_LT_OQ));
}

__m256i fuse_distances(__m256i voxels, __m256 sdf_m, const Lanes& lanes) {
  const __m256 one = _mm256_set1_ps(1.0F);
  const __m256 mean = _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(voxels, 16), 16));
  const __m256 weight = _mm256_cvtepi32_ps(_mm256_srli_epi32(voxels, 16));
  const __m256 raised = _mm256_add_ps(weight, one);
  const __m256 measured = _mm256_mul_ps(
      _mm256_min_ps(_mm256_mul_ps(sdf_m, lanes.inverse_truncation), one), _mm256_set1_ps(kScale));
  const __m256 fused = _mm256_mul_ps(_mm256_add_ps(_mm256_mul_ps(mean, weight), measured),
                                     _mm256_div_ps(one, raised));
  const __m256 negative = _mm256_cmp_ps(fused, _mm256_setzero_ps(), _CMP_LT_OQ);
  const __m256 half = _mm256_blendv_ps(_mm256_set1_ps(0.5F), _mm256_set1_ps(-0.5F), negative);
  const __m256i rounded = _mm256_cvttps_epi32(_mm256_add_ps(fused, half));
  const __m256i capped = _mm256_cvttps_epi32(_mm256_min_ps(raised, lanes.max_weight));
  return _mm256_or_si256(_mm256_and_si256(rounded, _mm256_set1_epi32(0xFFFF)),
                         _mm256_slli_epi32(capped, 16));
}

__m256i fuse_colors(__m256i colors, __m256i pixels, const Lanes& lanes) {
  const __m256i byte = _mm256_set1_epi32(0xFF);
  const __m256 weight = _mm256_cvtepi32_ps(_mm256_srli_epi32(colors, 24));
  const __m256 raised = _mm256_add_ps(weight, _mm256_set1_ps(1.0F));
  const __m256 inverse_raised = _mm256_div_ps(_mm256_set1_ps(1.0F), raised);
  const __m256i capped = _mm256_cvttps_epi32(_mm256_min_ps(raised, lanes.max_color_weight));
  __m256i result = _mm256_slli_epi32(capped, 24);
  for (int shift = 0; shift < 24; shift += 8) {
    const __m256 mean =
        _mm256_cvtepi32_ps(_mm256_and_si256(_mm256_srli_epi32(colors, shift), byte));
    const __m256 measured =
        _mm256_cvtepi32_ps(_mm256_and_si256(_mm256_srli_epi32(pixels, shift), byte));
    const __m256 fused = _mm256_add_ps(
        _mm256_mul_ps(_mm256_add_ps(_mm256_mul_ps(mean, weight), measured), inverse_raised),
        _mm256_set1_ps(0.5F));
    result = _mm256_or_si256(result, _mm256_slli_epi32(_mm256_cvttps_epi32(fused), shift));
  }
  return result;
}

void fuse_row(const KernelFrame& frame, const Lanes& lanes, const float row_C[3],
              std::uint32_t* voxel_row, std::uint32_t* color_row) {
  const __m256 x = _mm256_add_ps(_mm256_set1_ps(row_C[0]), lanes.along_x[0]);
  const __m256 y = _mm256_add_ps(_mm256_set1_ps(row_C[1]), lanes.along_x[1]);
  const __m256 z = _mm256_add_ps(_mm256_set1_ps(row_C[2]), lanes.along_x[2]);
  const __m256 inverse_z = _mm256_div_ps(_mm256_set1_ps(1.0F), z);
  const __m256 u =
      _mm256_add_ps(_mm256_mul_ps(_mm256_mul_ps(x, inverse_z), lanes.fx), lanes.cx_plus_half);
  const __m256 v =
      _mm256_add_ps(_mm256_mul_ps(_mm256_mul_ps(y, inverse_z), lanes.fy), lanes.cy_plus_half);
  __m256 mask = both(_mm256_cmp_ps(z, _mm256_setzero_ps(), _CMP_GT_OQ),
                     both(is_within(u, lanes.width), is_within(v, lanes.height)));
  if (none(mask)) return;

  const __m256i pixel = _mm256_add_epi32(_mm256_mullo_epi32(_mm256_cvttps_epi32(v), lanes.stride),
                                         _mm256_cvttps_epi32(u));
  const __m256 depth = _mm256_mask_i32gather_ps(_mm256_setzero_ps(), frame.depth_m, pixel, mask, 4);
  const __m256 sdf_m = _mm256_sub_ps(depth, z);
  const __m256 minus_truncation = _mm256_sub_ps(_mm256_setzero_ps(), lanes.truncation);
  mask = both(mask, both(_mm256_cmp_ps(depth, lanes.min_depth, _CMP_GE_OQ),
                         _mm256_cmp_ps(depth, lanes.max_depth, _CMP_LE_OQ)));
  mask = both(mask, _mm256_cmp_ps(sdf_m, minus_truncation, _CMP_GE_OQ));
  if (none(mask)) return;

  auto* voxel_lanes = reinterpret_cast<__m256i*>(voxel_row);
  const __m256i voxels = _mm256_load_si256(voxel_lanes);
  _mm256_store_si256(voxel_lanes, choose(mask, fuse_distances(voxels, sdf_m, lanes), voxels));
  if (frame.color_rgbx == nullptr) return;
  mask = both(mask, _mm256_cmp_ps(sdf_m, lanes.truncation, _CMP_LT_OQ));
  if (none(mask)) return;
  auto* color_lanes = reinterpret_cast<__m256i*>(color_row);
  const __m256i colors = _mm256_load_si256(color_lanes);
  const __m256i pixels = _mm256_mask_i32gather_epi32(_mm256_setzero_si256(),
                                                     reinterpret_cast<const int*>(frame.color_rgbx),
                                                     pixel, _mm256_castps_si256(mask), 4);
  _mm256_store_si256(color_lanes, choose(mask, fuse_colors(colors, pixels, lanes), colors));
}

}  // namespace

void integrate_block_avx2(const KernelFrame& frame, const KernelBlock& block) {
  const Lanes lanes(frame);
  std::uint32_t* voxels = block.voxels;
  std::uint32_t* colors = block.colors;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      float row_C[3];
      for (int i = 0; i < 3; ++i) {
        row_C[i] = block.origin_C[i] + (static_cast<float>(z) * frame.step_C[2][i] +
                                        static_cast<float>(y) * frame.step_C[1][i]);
      }
      fuse_row(frame, lanes, row_C, voxels, colors);
      voxels += kSide;
      colors += kSide;
    }
  }
}

}  // namespace kintsugi::mapper
