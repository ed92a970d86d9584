#include "tests/fuzz/faulty_engine.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "segmenter/core/make_engine.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

class FaultyEngine final : public SegmentationEngine {
 public:
  FaultyEngine(std::unique_ptr<SegmentationEngine> engine, const EngineConfig& config, Fault fault,
               std::size_t step)
      : engine_(std::move(engine)),
        joins_fragments_(config.fragment_limit() > 0),
        fault_(fault),
        steps_left_(step) {}

  RunStatistics update(const CloudChange& change) override {
    const RunStatistics statistics = engine_->update(change);
    components_.assign(engine_->components().begin(), engine_->components().end());
    changed_.assign(engine_->changed().begin(), engine_->changed().end());
    wrong_theta_.reset();
    if (steps_left_ > 0) {
      --steps_left_;
    } else if (fault_ != Fault::kNone && spoil(change)) {
      fault_ = Fault::kNone;
    }
    return statistics;
  }
  std::span<const ComponentId> components() const override { return components_; }
  std::span<const ComponentId> unmerged_components() const override {
    return joins_fragments_ ? engine_->unmerged_components() : components_;
  }
  std::span<const PointIndex> changed() const override { return changed_; }
  std::size_t bytes() const override { return engine_->bytes(); }
  double theta(ComponentId component) const override {
    const double theta = engine_->theta(component);
    return wrong_theta_ == component ? std::nextafter(theta, 0.0) : theta;
  }

 private:
  /// False when this update leaves no room for the fault.
  bool spoil(const CloudChange& change) {
    switch (fault_) {
      case Fault::kNone:
        return false;
      case Fault::kWrongLabel:
        return mislabel_a_point();
      case Fault::kWrongTheta: {
        const auto live = std::ranges::find_if(
            components_, [](ComponentId component) { return component != kNoComponent; });
        if (live == components_.end()) return false;
        wrong_theta_ = *live;
        return true;
      }
      case Fault::kGoneStays:
        if (change.removed.empty()) return false;
        components_[change.removed.front()] = 0;
        return true;
      case Fault::kChangeLeftOut:
        if (changed_.empty()) return false;
        changed_.pop_back();
        return true;
      case Fault::kChangeMadeUp:
        return make_up_a_change();
      case Fault::kNameOutOfRange:
        if (changed_.empty()) return false;
        components_[changed_.front()] = static_cast<ComponentId>(components_.size());
        return true;
      case Fault::kThrows:
        throw std::logic_error("a fault");
    }
    return false;
  }

  /// A changed point goes to another component.
  bool mislabel_a_point() {
    for (const PointIndex i : changed_) {
      for (const ComponentId component : components_) {
        if (component == kNoComponent || component == components_[i]) continue;
        // A point alone that goes where another one is alone would be a mere renaming.
        if (std::ranges::count(components_, component) < 2) continue;
        components_[i] = component;
        return true;
      }
    }
    return false;
  }

  bool make_up_a_change() {
    for (PointIndex i = 0; i < components_.size(); ++i) {
      const auto place = std::ranges::lower_bound(changed_, i);
      const bool has_changed = place != changed_.end() && *place == i;
      if (components_[i] == kNoComponent || has_changed) continue;
      changed_.insert(place, i);
      return true;
    }
    return false;
  }

  std::unique_ptr<SegmentationEngine> engine_;
  bool joins_fragments_;
  Fault fault_;
  std::size_t steps_left_;
  std::vector<ComponentId> components_;
  std::vector<PointIndex> changed_;
  std::optional<ComponentId> wrong_theta_;
};

}  // namespace

EngineFactory faulty(const EngineFactory& make_engine, Fault fault, std::size_t step) {
  return [=](const PointCloud& cloud, const EngineConfig& config) {
    return std::make_unique<FaultyEngine>(make_engine(cloud, config), config, fault, step);
  };
}

}  // namespace kintsugi::segmenter::fuzz
