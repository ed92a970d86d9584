#pragma once

#include <cstddef>
#include <iterator>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Lists of points: circular and doubly linked, with the links in arrays by point. Insertion and
/// removal take constant time and no allocation.
///
/// A list is given by any one of its points, the head. Operations return the head to use from then
/// on.
class MemberLists {
 public:
  static constexpr PointIndex kEmpty = UINT32_MAX;

  void resize(PointIndex num_points) { links_.resize(num_points); }
  void swap_to(SwapSpace& space) { links_.swap_to(space); }
  std::size_t bytes() const { return links_.bytes(); }

  /// Puts `point`, which is in no list, into the list of `head` (kEmpty: a new one).
  PointIndex insert(PointIndex head, PointIndex point) {
    if (head == kEmpty) {
      links_[point] = {point, point};
      return point;
    }
    const PointIndex last = links_[head].previous;
    links_[point] = {last, head};
    links_[last].next = point;
    links_[head].previous = point;
    return head;
  }

  /// Removes `point` from the list of `head`.
  PointIndex erase(PointIndex head, PointIndex point) {
    const Link link = links_[point];
    links_[link.previous].next = link.next;
    links_[link.next].previous = link.previous;
    if (head != point) return head;
    return link.next == point ? kEmpty : link.next;
  }

  /// The points of one list, in no particular order. Valid while the lists do not change.
  class List {
   public:
    class Iterator {
     public:
      using iterator_category = std::forward_iterator_tag;
      using value_type = PointIndex;
      using difference_type = std::ptrdiff_t;
      using pointer = const PointIndex*;
      using reference = PointIndex;

      Iterator() = default;
      Iterator(const MemberLists* lists, PointIndex head, PointIndex at)
          : lists_(lists), head_(head), at_(at) {}
      PointIndex operator*() const { return at_; }
      Iterator& operator++() {
        at_ = lists_->links_[at_].next;
        if (at_ == head_) at_ = kEmpty;
        return *this;
      }
      Iterator operator++(int) {
        const Iterator before = *this;
        ++*this;
        return before;
      }
      bool operator==(const Iterator& other) const { return at_ == other.at_; }

     private:
      const MemberLists* lists_ = nullptr;
      PointIndex head_ = kEmpty;
      PointIndex at_ = kEmpty;
    };

    List(const MemberLists& lists, PointIndex head) : lists_(&lists), head_(head) {}
    Iterator begin() const { return {lists_, head_, head_}; }
    Iterator end() const { return {lists_, head_, kEmpty}; }
    bool empty() const { return head_ == kEmpty; }

   private:
    const MemberLists* lists_;
    PointIndex head_;
  };
  List list(PointIndex head) const { return {*this, head}; }

 private:
  struct Link {
    PointIndex previous;
    PointIndex next;
  };
  GrowingArray<Link> links_;
};

}  // namespace kintsugi::segmenter
