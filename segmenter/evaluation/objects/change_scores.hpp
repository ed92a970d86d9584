#pragma once
// Which of the changes between two maps were told, and which told ones are true.

#include "segmenter/evaluation/objects/object_scores.hpp"
#include "segmenter/evaluation/objects/told_changes.hpp"
#include "segmenter/evaluation/objects/true_objects.hpp"
#include "segmenter/evaluation/quality/ground_truth.hpp"

namespace kintsugi::segmenter {

/// A told change is right if more than half of its points belong to one truly changed object, its
/// kind fits (gone or new fits a moved object, too), and it covers at least half of that object's
/// points on a side that it tells. A point belongs to the nearest true point within
/// `max_distance_m`: as it was, of `before`, as it is, of `after`. Surface that something uncovered
/// belongs to an object that did not change, and so is no true change. An object is found when
/// something right was told of it; only objects of 50 points and more are expected.
/// @param before in BEFORE's W; `after` in AFTER's W
ObjectScores score_changes(const ToldChanges& told, const TrueObjects& objects, const Truth& before,
                           const Truth& after, double max_distance_m);

}  // namespace kintsugi::segmenter
