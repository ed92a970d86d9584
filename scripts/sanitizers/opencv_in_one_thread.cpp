// For the thread sanitizer, in every program that uses OpenCV: its parallel loops run in the thread
// that begins them. The part of TBB that is compiled into OpenCV is not instrumented: how such a
// loop waits for its workers is not seen, and they look at its context, which is on the stack of
// who began it.

// As in opencv2/core/utility.hpp. clang-tidy, which takes the options of other builds, has no
// header of OpenCV here.
namespace cv {
void setNumThreads(int nthreads);
}

namespace {

[[maybe_unused]] const bool is_set = (cv::setNumThreads(1), true);

}  // namespace
