#pragma once
// The names of the channels. README.md lists the type, the sender and the receivers of each.

namespace kintsugi::channels {

inline constexpr char kCloudSlice[] = "CLOUD_SLICE";
inline constexpr char kCameraPose[] = "CAMERA_POSE";
inline constexpr char kCameraView[] = "CAMERA_VIEW";
inline constexpr char kKeyframe[] = "KEYFRAME";
inline constexpr char kRgbdFrame[] = "RGBD_FRAME";
inline constexpr char kSegmentUpdate[] = "SEGMENT_UPDATE";
inline constexpr char kSegmentQuery[] = "SEGMENT_QUERY";
inline constexpr char kSegmentAnswer[] = "SEGMENT_ANSWER";
inline constexpr char kSnapshot[] = "SNAPSHOT";
inline constexpr char kObjectDetection[] = "OBJECT_DETECTION";
inline constexpr char kChangeReport[] = "CHANGE_REPORT";
inline constexpr char kMapperStatus[] = "MAPPER_STATUS";
inline constexpr char kSegmenterStatus[] = "SEGMENTER_STATUS";
inline constexpr char kViewerStatus[] = "VIEWER_STATUS";
inline constexpr char kDetectorStatus[] = "DETECTOR_STATUS";
inline constexpr char kHeartbeat[] = "HEARTBEAT";
inline constexpr char kResendRequest[] = "RESEND_REQUEST";
inline constexpr char kChunksReplaced[] = "CHUNKS_REPLACED";

}  // namespace kintsugi::channels
