"""scripts/fleet: many clouds, logs and recordings, each a task of its own. Python's standard library only.

    options     the command line
    inputs      the list: its lines, and the names of the inputs
    work        what an input is, and the programs that are run on it
    folder      the folder of a fleet: what it is of, lock, results, tasks that are to do
    measures    time and memory of a program; points, segments and quality from the files it wrote
    task        one task: an input becomes a result
    rounds      gives the tasks to a scheduler until each has a result
    slurm, local  the schedulers: job arrays of Slurm, or GNU parallel on this machine
    table       results as CSV, and their sums
    figures     the plots, drawn by gnuplot
    page        the report page
    commands    scripts/fleet itself
"""
