#pragma once
// Programs drawn at random: lines, arcs and blends of very different sizes, and limits that do not fit them.

#include <cstdint>
#include <random>
#include <vector>

#include "axes/path/path.hpp"
#include "axes/path_time/curve.hpp"

namespace taktwerk::axes {

class RandomProgram {
public:
    explicit RandomProgram(std::uint64_t seed) : random_(seed) {}

    [[nodiscard]] double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    [[nodiscard]] double between_decades(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
    [[nodiscard]] int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

    /// From 1 to 200, as often as n^-1.5: 32 % have one move, 14 % more than 25, 3 % more than 100; 13.7 in the mean.
    [[nodiscard]] int how_many() {
        const double least = 1 / std::sqrt(201.0);
        return static_cast<int>(std::pow(1 - uniform(0, 1) * (1 - least), -2));
    }

    [[nodiscard]] PathVector direction(int dimensions) {
        PathVector d = PathVector::Zero();
        do {
            for (int i = 0; i < dimensions; ++i) d[i] = uniform(-1, 1);
        } while (d.norm() < 0.1 || d.norm() > 1);
        return d / d.norm();
    }

    /// Limits of axes: velocity, and times in which it is reached and in which acceleration is.
    [[nodiscard]] std::vector<PathAxisLimits> limits(int axes, double velocity) {
        std::vector<PathAxisLimits> all;
        for (int i = 0; i < axes; ++i) {
            PathAxisLimits l;
            l.velocity = velocity * between_decades(0.3, 3);
            l.acceleration = l.velocity / between_decades(0.03, 0.5);
            l.jerk = l.acceleration / between_decades(0.01, 0.2);
            all.push_back(l);
        }
        return all;
    }

    [[nodiscard]] PathFeed feed(double velocity) {
        PathFeed f;
        f.velocity = velocity * between_decades(0.1, 10);
        f.acceleration = f.velocity / between_decades(0.02, 0.3);
        f.deceleration = f.acceleration * between_decades(0.5, 2);
        f.jerk = f.acceleration / between_decades(0.01, 0.1);
        return f;
    }

    /// A line or (in a plane through three random directions) an arc or helix from `from`, about as long as `size`.
    [[nodiscard]] PathElement element(const PathVector& from, double size, int dimensions) {
        const double length = size * between_decades(0.05, 2);
        if (dimensions < 2 || uniform(0, 1) < 0.65) return PathElement::line(from, from + length * direction(dimensions));
        PathVector a = direction(std::min(dimensions, 3)), b = direction(std::min(dimensions, 3));
        b -= a.dot(b) * a;
        if (b.norm() < 0.1) return PathElement::line(from, from + length * direction(dimensions));
        b /= b.norm();
        const double turn = uniform(0.2, 4), radius = length / turn;
        PathVector drift = PathVector::Zero();
        if (dimensions == 3 && uniform(0, 1) < 0.3) drift.head<3>() = uniform(-0.3, 0.3) * radius * a.head<3>().cross(b.head<3>());
        return PathElement::arc(from - radius * a, radius * a, radius * b, drift, turn);
    }

    /// A path of `count` moves from the origin. Its corners are blended at random: by distance, by deviation, some not at all.
    [[nodiscard]] Path path(int count, double size, int dimensions, double velocity, double blended = 0.9) {
        Path path;
        PathVector at = PathVector::Zero();
        for (int i = 0; i < count; ++i) {
            PathMove move;
            move.element = element(at, size, dimensions);
            move.feed = feed(velocity);
            move.command = static_cast<std::uint32_t>(i + 1);
            at = move.element.at(move.element.length()).at;
            BlendRequest request;
            if (uniform(0, 1) < blended)
                request = {uniform(0, 1) < 0.5 ? BlendRule::corner_distance : BlendRule::corner_deviation,
                           size * between_decades(1e-3, 0.5)};
            if (!path.append(move, request).ok()) break;
        }
        return path;
    }

private:
    std::mt19937_64 random_;
};

}  // namespace taktwerk::axes
