#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "io/geometry.hpp"
#include "io/run/checkpoint.hpp"
#include "kernels/portable.h"

namespace selvage {

/// Puts values into a checkpoint under their names.
struct CheckpointSaver {
    Checkpoint& to;

    void operator()(std::string_view name, int value) const { to.integers[std::string(name)] = {value}; }
    void operator()(std::string_view name, bool value) const { to.integers[std::string(name)] = {value}; }
    void operator()(std::string_view name, double value) const { to.reals[std::string(name)] = {value}; }
    void operator()(std::string_view name, const std::vector<real>& values) const
    {
        to.reals[std::string(name)] = values;
    }
    void operator()(std::string_view name, const std::vector<int>& values) const
    {
        to.integers[std::string(name)] = values;
    }
    void operator()(std::string_view name, const std::vector<char>& values) const
    {
        to.integers[std::string(name)].assign(values.begin(), values.end());
    }
    void operator()(std::string_view name, const std::vector<float>& values) const
    {
        to.reals[std::string(name)].assign(values.begin(), values.end());
    }
    void operator()(std::string_view name, const std::vector<Vec3>& values) const;
};

/// Takes values out of a checkpoint and checks them. Whatever is wrong is an InputError with the name of the value.
struct CheckpointLoader {
    const Checkpoint& from;
    const std::string& path;

    /// @throws InputError always
    [[noreturn]] void refuse(std::string_view name, const std::string& found, const std::string& expected) const;

    /// @throws InputError if there is no such array, or it is of another size, or a number is not finite
    const std::vector<double>& reals(std::string_view name, std::size_t size) const;
    const std::vector<int>& integers(std::string_view name, std::size_t size) const;
    const std::vector<double>& reals(std::string_view name) const;           ///< Of any size.
    const std::vector<int>& integers(std::string_view name) const;           ///< Of any size.
    int integer(std::string_view name, int low, int high) const;             ///< In [low, high].
    std::vector<char> flags(std::string_view name, std::size_t size) const;  ///< 0 or 1.
    std::vector<Vec3> vectors(std::string_view name) const;                  ///< Of any number.
    std::string word(const std::string& name) const;                         ///< Empty if there is none.

    /// With room to count on, up or down.
    void operator()(std::string_view name, int& value) const { value = integer(name, -(1 << 30), 1 << 30); }
    void operator()(std::string_view name, bool& value) const { value = integer(name, 0, 1) == 1; }
    void operator()(std::string_view name, double& value) const { value = reals(name, 1)[0]; }
    /// Only of the size that the array has.
    void operator()(std::string_view name, std::vector<real>& values) const { values = reals(name, values.size()); }
};

}  // namespace selvage
