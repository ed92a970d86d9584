"""The measurements behind scripts/bench and BENCHMARK.md. Python's standard library only.

    commands      the command line, and the order of the sections
    document      replaces what is between the markers of a section in BENCHMARK.md
    tables        Markdown tables, CSV files, the output of Google Benchmark
    run           runs the programs over an input, in the folder of the measurement
    live          the section about live runs
    mapping       sections about the mapper
    recordings    the section about recordings of any kind
    battery       the section about synthetic rooms under many conditions; battery_cases, battery_picture
    accuracy      errors of the camera's path, also of a map of several parts
    segmenting    sections about the segmenter
    fleets        the section about many clouds at a time
    objects       the section about changes and objects; object_libraries, large_maps
    others        sections about the viewer, the bus, the machine and the source code
    summary       the main results, out of the tables of the sections
"""
