#pragma once
// What most sources include, precompiled once (KintsugiPrecompile.cmake). No header of our own is
// here, so that no change of ours makes everything compile again. Every source still includes what
// it uses: scripts/lint reads each without this file.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

// Tools other than GCC read this as an ordinary header, and not every target sees OpenCV.
#if __has_include(<opencv2/core.hpp>)
#include <opencv2/core.hpp>
#endif
