#include "viewer/output/h264_encoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace kintsugi::viewer {
namespace {

std::string text_of_error(int result) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(result, text.data(), text.size());
  return text.data();
}

template <class T>
T* require_memory(T* allocated) {
  if (allocated == nullptr) throw std::bad_alloc();
  return allocated;
}

const AVCodec* find_encoder() {
  if (const AVCodec* const x264 = avcodec_find_encoder_by_name("libx264")) return x264;
  if (const AVCodec* const other = avcodec_find_encoder(AV_CODEC_ID_H264)) return other;
  throw std::runtime_error(
      "libavcodec has no H.264 encoder: install the package libavcodec59 of Debian, which has "
      "libx264");
}

}  // namespace

void H264Encoder::Free::operator()(AVCodecContext* context) const {
  avcodec_free_context(&context);
}
void H264Encoder::Free::operator()(AVFormatContext* context) const {
  if (context->pb != nullptr) avio_closep(&context->pb);
  avformat_free_context(context);
}
void H264Encoder::Free::operator()(AVFrame* frame) const { av_frame_free(&frame); }
void H264Encoder::Free::operator()(AVPacket* packet) const { av_packet_free(&packet); }
void H264Encoder::Free::operator()(SwsContext* context) const { sws_freeContext(context); }

H264Encoder::H264Encoder(const std::filesystem::path& file, cv::Size size, double pictures_per_s)
    : path_(file) {
  av_log_set_level(AV_LOG_ERROR);
  AVFormatContext* container = nullptr;
  check(avformat_alloc_output_context2(&container, nullptr, "mp4", file.c_str()), "write");
  file_.reset(container);
  open_encoder({size.width & ~1, size.height & ~1}, pictures_per_s);
  open_file();

  frame_.reset(require_memory(av_frame_alloc()));
  frame_->format = encoder_->pix_fmt;
  frame_->width = encoder_->width;
  frame_->height = encoder_->height;
  check(av_frame_get_buffer(frame_.get(), 0), "get memory for");
  packet_.reset(require_memory(av_packet_alloc()));
  to_yuv_.reset(require_memory(sws_getContext(encoder_->width, encoder_->height, AV_PIX_FMT_BGR24,
                                              encoder_->width, encoder_->height, encoder_->pix_fmt,
                                              SWS_BILINEAR, nullptr, nullptr, nullptr)));
  const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
  constexpr int kNeutral = 1 << 16;
  sws_setColorspaceDetails(to_yuv_.get(), bt709, 1, bt709, 0, 0, kNeutral, kNeutral);
}

H264Encoder::~H264Encoder() = default;

void H264Encoder::open_encoder(cv::Size size, double pictures_per_s) {
  constexpr int kMaxDenominator = 1'000'000;
  constexpr double kSeconds = 5.0;  // between two pictures that can be jumped to
  const AVCodec* const codec = find_encoder();
  encoder_.reset(require_memory(avcodec_alloc_context3(codec)));
  encoder_->width = size.width;
  encoder_->height = size.height;
  encoder_->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder_->framerate = av_d2q(pictures_per_s, kMaxDenominator);
  encoder_->time_base = av_inv_q(encoder_->framerate);
  encoder_->gop_size = std::max(1, static_cast<int>(std::lround(kSeconds * pictures_per_s)));
  encoder_->color_range = AVCOL_RANGE_MPEG;
  encoder_->colorspace = AVCOL_SPC_BT709;
  encoder_->color_primaries = AVCOL_PRI_BT709;
  encoder_->color_trc = AVCOL_TRC_BT709;
  encoder_->thread_count = 1;  // the other processes of the run need the processor
  if ((file_->oformat->flags & AVFMT_GLOBALHEADER) != 0) {
    encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  }
  // Options of libx264; another encoder has its own. The quality is constant. The fastest preset
  // takes 4.5 ms for a picture of 1280 x 720, "superfast" 11 ms for a file that is a third smaller.
  av_opt_set(encoder_->priv_data, "preset", "ultrafast", 0);
  av_opt_set(encoder_->priv_data, "crf", "23", 0);
  check(avcodec_open2(encoder_.get(), codec, nullptr), "open the H.264 encoder for");
}

void H264Encoder::open_file() {
  AVStream* const stream = require_memory(avformat_new_stream(file_.get(), nullptr));
  stream->time_base = encoder_->time_base;
  stream->avg_frame_rate = encoder_->framerate;
  check(avcodec_parameters_from_context(stream->codecpar, encoder_.get()), "describe");
  check(avio_open(&file_->pb, path_.c_str(), AVIO_FLAG_WRITE), "open");
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "+faststart", 0);
  const int result = avformat_write_header(file_.get(), &options);
  av_dict_free(&options);
  check(result, "write");
}

void H264Encoder::add(const cv::Mat3b& image) {
  check(av_frame_make_writable(frame_.get()), "get memory for");
  const std::array<const std::uint8_t*, 1> data{image.ptr()};
  const std::array<int, 1> stride{static_cast<int>(image.step)};
  sws_scale(to_yuv_.get(), data.data(), stride.data(), 0, encoder_->height, frame_->data,
            frame_->linesize);
  frame_->pts = pictures_++;
  encode(frame_.get());
}

/// nullptr: encodes what the encoder still has.
void H264Encoder::encode(const AVFrame* frame) {
  check(avcodec_send_frame(encoder_.get(), frame), "encode");
  for (;;) {
    const int result = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
    check(result, "encode");
    AVStream* const stream = file_->streams[0];
    packet_->duration = 1;
    av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream->time_base);
    packet_->stream_index = stream->index;
    check(av_interleaved_write_frame(file_.get(), packet_.get()), "write");
    check(file_->pb->error, "write");
  }
}

void H264Encoder::finish() {
  encode(nullptr);
  check(av_write_trailer(file_.get()), "write the index of");
  check(avio_closep(&file_->pb), "close");
}

void H264Encoder::check(int result, const std::string& action) const {
  if (result >= 0) return;
  throw std::runtime_error("cannot " + action + " video '" + path_.string() +
                           "': " + text_of_error(result));
}

}  // namespace kintsugi::viewer
