#pragma once
// What the main() of every program does around the program's own code.

#include <functional>

namespace kintsugi {

/// Calls `run` and returns its exit code. When `run` throws, or standard output was not written,
/// writes "PROGRAM: MESSAGE" to stderr and returns 1; PROGRAM is the file name in `argv[0]`. Usual
/// form:
///
///   int main(int argc, char** argv) {
///     return kintsugi::run_main(argv, [&] {
///       Options options;
///       CLI::App app{"..."};
///       add_options(app, options);
///       CLI11_PARSE(app, argc, argv);  // --help and wrong flags return from here
///       return run(options);
///     });
///   }
int run_main(const char* const* argv, const std::function<int()>& run);

}  // namespace kintsugi
