#include "birm3d/model/barrier.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "birm3d/base/error.hpp"
#include "birm3d/base/tolerances.hpp"
#include "birm3d/geometry/top_edge.hpp"

namespace birm3d {

namespace {

Vec3 end_of(const Element& element, double y) {
    return element.position + Eigen::AngleAxisd(element.heading, Vec3::UnitZ()) * Vec3(0.0, y, 0.0);
}

// Solids of the elements; refuses those that can not stand free, and pinned ones whose ends do not meet.
std::vector<MovingElement> segments_of(const std::vector<Element>& elements, const FreeStanding& free) {
    require_not_negative("ground_friction", free.ground_friction);
    std::vector<MovingElement> segments;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const std::string name = "elements[" + std::to_string(i) + "]";
        const auto* prism = std::get_if<Prism>(&elements[i].shape);
        if (prism == nullptr) refuse(name, "a prism where it is free-standing", "another shape");
        if (elements[i].part_of) refuse(name + " part_of", "none where it is free-standing", "an index");
        if (elements[i].upright) refuse(name + " upright", "false where it is free-standing", "true");
        if (elements[i].draws_in_above)
            refuse(name + " draws_in_above", "false where it is free-standing", "true");
        if (elements[i].position.z() != 0.0)
            refuse(name + " height", "0 m where it is free-standing", elements[i].position.z());
        segments.push_back(segment_of(*prism, free.density));
        if (i == 0 || free.joint == SegmentJoint::loose) continue;
        const double apart = (end_of(elements[i - 1], segments[i - 1].half_length) -
                              end_of(elements[i], -segments[i].half_length))
                                 .norm();
        if (!(apart <= tolerance::joint_fit))
            refuse("distance of the pinned ends of " + name + " and the one before it",
                   "<= " + to_text(tolerance::joint_fit) + " m", apart);
    }
    return segments;
}

std::vector<MovingElement> posts_of(const std::vector<Element>& elements, const YieldingPosts& yielding) {
    std::vector<MovingElement> posts;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const auto* post = std::get_if<Post>(&elements[i].shape);
        if (post == nullptr || post->opens || elements[i].part_of)
            refuse("elements[" + std::to_string(i) + "]", "a whole post where posts yield", "another shape");
        posts.push_back(tilting_post(*post, yielding, -elements[i].position.z()));
    }
    return posts;
}

}  // namespace

Mat3 Element::rotation() const {
    Mat3 raised;
    raised << 1.0, 0.0, 0.0,  //
        0.0, 0.0, -1.0,       //
        0.0, 1.0, 0.0;
    Mat3 turned = Eigen::AngleAxisd(heading, Vec3::UnitZ()).toRotationMatrix();
    if (upright) turned *= raised;
    return turned;
}

Barrier::Barrier(std::vector<Element> elements_, double friction_, const Vec3& origin_, double heading_,
                 const std::optional<FreeStanding>& free_standing_,
                 const std::optional<YieldingPosts>& yielding_)
    : elements(std::move(elements_)),
      friction(require_not_negative("friction", friction_)),
      origin(origin_),
      heading(require_finite("heading", heading_)),
      free_standing(free_standing_),
      yielding(yielding_) {
    if (!origin.allFinite()) refuse("origin", "finite", "a coordinate that is not");
    if (free_standing && origin.z() != 0.0)
        refuse("origin height", "0 m where it is free-standing", origin.z());
    if (elements.empty()) refuse("elements", "at least 1", 0.0);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const std::string name = "elements[" + std::to_string(i) + "] ";
        if (!elements[i].position.allFinite())
            refuse(name + "position", "finite", "a coordinate that is not");
        require_finite((name + "heading").c_str(), elements[i].heading);
        const auto& whole = elements[i].part_of;
        if (whole && !(*whole < i && !elements[*whole].part_of))
            refuse(name + "part_of", "an element before it that is no part itself",
                   static_cast<double>(*whole));
        if (!elements[i].draws_in_above) continue;
        const auto* prism = std::get_if<Prism>(&elements[i].shape);
        if (prism == nullptr || elements[i].upright)
            refuse(name + "draws_in_above", "false where it is no prism along the line", "true");
        top_edge_of(*prism);
    }
    if (free_standing && yielding) refuse("yielding", "none where it is free-standing", "posts");
    if (free_standing) moving_elements = segments_of(elements, *free_standing);
    if (yielding) moving_elements = posts_of(elements, *yielding);
}

Barrier Barrier::wall(double friction, const Vec3& origin, double heading) {
    return {{{HalfSpace{}, Vec3::Zero(), heading}}, friction, origin, heading, {}};
}

Barrier Barrier::pole(double friction, const Vec3& origin, double heading, double radius) {
    require_positive("radius", radius);
    const Post post{radius, infinity};
    return {{{post, Vec3::Zero(), heading}}, friction, origin, heading, {}};
}

Vec3 Barrier::normal() const {
    return {-std::cos(heading), -std::sin(heading), 0.0};
}

double Barrier::top() const {
    double top = -infinity;
    for (const Element& element : elements) {
        if (const auto* post = std::get_if<Post>(&element.shape)) {  // its bounds are endless
            top = std::max(top, origin.z() + element.position.z() + post->height);
            continue;
        }
        const Box box = bounds(element.shape).placed(element.rotation(), element.position);
        top = std::max(top, origin.z() + box.center.z() + box.half.z());
    }
    return top;
}

}  // namespace birm3d
