// Reads a log, and prints the segments and the points of the map.

#include <exception>
#include <iostream>

#include <kintsugi/bus.hpp>

int main(int argc, char** argv) {
  try {
    const kintsugi::MapClient map = kintsugi::read_log(argc > 1 ? argv[1] : "");
    if (!kintsugi::PatchPose().is_valid()) return 3;  // it is in this library, too
    std::size_t num_points = 0;
    for (const int piece : map.pieces()) num_points += map.points_W(piece)->size();
    std::cout << map.segments().size() << " segments, " << num_points << " points\n";
    return map.problem().empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
