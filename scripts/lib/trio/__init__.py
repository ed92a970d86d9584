"""The supervisor behind scripts/trio and scripts/replay: starts mapper, segmenter and viewer (or a
log player instead of the mapper), watches them, and stops them. Python's standard library only.

    options       the command lines of scripts/trio and scripts/replay
    process_options  the options of one process, from both
    network       can LCM work on this machine? if not: a private network
    check         do the processes accept their options?
    run_folder    the folder of a run: lock, earlier runs, options for --resume
    process       one process: start, signals, exit code, CPU time, memory, log
    map_name      the name of the map, which no other mapper on the bus may have
    status        what the processes say on the bus, through kintsugi-status
    supervisor    the rules: order, restarts, errors, end of a run
    summary       what a run took and wrote
    commands      scripts/trio and scripts/replay themselves
"""
