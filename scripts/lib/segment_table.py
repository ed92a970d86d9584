"""The segments of a map as a client knows them from SEGMENT_UPDATE alone."""

from segment_updates import CREATED, MERGED, RETIRED, SPLIT


class SegmentTable:
    """The segments of one map. Updates may be applied in any order and repeatedly.

    It follows the same rules as SegmentTable in lcmtypes/client/segment_table.hpp, which explains them:
    an id that no longer exists is never used again, the newest statistics of a segment hold, and a
    segment that is missing in an update that lists all segments no longer exists.
    """

    def __init__(self):
        self.newest = None   # the newest update
        self.listed = -1     # number of the newest update that listed all segments
        self.is_final = False
        self.segments = {}   # id -> (number of the update, Statistics)
        self.born = {}       # id -> {slice, parent}
        self.gone = set()

    def apply(self, update):
        """Returns False if the update is ignored, because it is of an older session than the table."""
        if self.newest:
            age, present = self.age(update), self.age(self.newest)
            if age < present:
                return False
            if age > present:
                self.__init__()
        if not self.newest or update.sequence > self.newest.sequence:
            self.newest = update
        self.is_final = self.is_final or update.header.is_final
        for event in update.events:
            self.apply_event(event, update.header.slice_id)
        for statistics in update.statistics:
            self.apply_statistics(statistics, update.sequence)
        if update.lists_all() and update.sequence > self.listed:
            self.listed = update.sequence
            self.segments = {i: entry for i, entry in self.segments.items() if entry[0] >= self.listed}
        return True

    @staticmethod
    def age(update):
        return update.header.map_session, update.header.session

    def apply_event(self, event, slice_id):
        if event.type == CREATED:
            self.born[event.segment_id] = {"slice": slice_id, "parent": 0}
        elif event.type == SPLIT:
            self.born[event.other_id] = {"slice": slice_id, "parent": event.segment_id}
        elif event.type in (MERGED, RETIRED):
            gone = event.other_id if event.type == MERGED else event.segment_id
            self.gone.add(gone)
            self.segments.pop(gone, None)

    def apply_statistics(self, statistics, sequence):
        segment_id = statistics.id
        if segment_id in self.gone or sequence < self.listed:
            return
        if sequence > self.segments.get(segment_id, (-1,))[0]:
            self.segments[segment_id] = (sequence, statistics)

    def statistics(self):
        """The statistics of every existing segment, by ascending id."""
        return [self.segments[i][1] for i in sorted(self.segments)]

    def problem(self, assembler):
        """What is missing, as text; empty: nothing."""
        if not self.newest:
            return "no segment update was received"
        header = self.newest.header
        missing = assembler.num_missing(header.session, self.listed + 1)
        if missing > 0:
            return "%d chunks of updates are missing, and this program cannot request them" % missing
        if len(self.segments) != header.num_segments:
            return "the table has %d segments, the map %d" % (len(self.segments),
                                                              header.num_segments)
        return ""
