// kintsugi-keygen: makes the key of a bus.

#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/signing/bus_key.hpp"

int main(int argc, char** argv) {
  return kintsugi::run_main(argv, [&] {
    CLI::App app(
        "Writes a new random key of a bus, which only its owner may read. Programs with --bus-key "
        "FILE, or KINTSUGI_BUS_KEY=FILE, sign their messages with it and take only messages that "
        "are signed with it. All programs on a bus need the same key: copy the file to the other "
        "hosts on a way that nobody else can read, and keep its mode 0600.");
    std::string file;
    app.add_option("FILE", file, "the new file; one that exists is not replaced")
        ->required()
        ->type_name("");
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    kintsugi::write_new_bus_key(file);
    std::cerr << "wrote " << file << '\n';
    return 0;
  });
}
