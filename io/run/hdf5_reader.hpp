#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/run/hdf5_objects.hpp"

namespace selvage {

/// Reads datasets and attributes of a run or checkpoint by path. Shapes are row-major; numbers are converted.
///
/// Files are untrusted, see Hdf5Objects: every function throws InputError, naming the object, if that is missing or
/// damaged, has another shape or number type than asked for, or lies outside the file (external links and storage,
/// virtual datasets). All arrays and texts read from a file hold at most most_expansion times its bytes, and no array
/// more than its stored bytes can hold.
class Hdf5Reader {
public:
    /// Stands for an extent that may have any value.
    static constexpr std::uint64_t any = UINT64_MAX;

    /// Runs of sheets that lie still come to about 70, for their meshes are regular; a file of 0.1 MB may take 26 MB.
    static constexpr std::uint64_t most_expansion = 256;
    /// What deflate can make of a byte (zlib's technical details give 1032 : 1 as its limit).
    static constexpr std::uint64_t most_deflation = 1032;

    using Shape = std::vector<std::uint64_t>;

    /// @throws InputError if the file cannot be opened, is not a regular file or not HDF5
    explicit Hdf5Reader(const std::string& path) : path_(path), objects_(path) {}

    const std::string& path() const { return path_; }
    std::uint64_t size() const { return objects_.size(); }  ///< Length of the file [bytes].
    bool exists(const std::string& object) const;
    std::vector<std::string> members(const std::string& group) const;  ///< Sorted.

    Shape shape(const std::string& name) const;
    /// @param shape  that the dataset must have, see `any`; empty: every shape will do
    /// @param rows   if not `any`: only so many of its first rows are read; it may have more
    std::vector<double> read_reals(const std::string& name, const Shape& shape = {}, std::uint64_t rows = any) const;
    std::vector<std::int64_t> read_integers(const std::string& name, const Shape& shape = {},
                                            std::uint64_t rows = any) const;
    /// Reads integers, each of which must be in [0, count).
    /// @param what  what they are indices of, as in `point`
    std::vector<int> read_indices(const std::string& name, const Shape& shape, std::int64_t count,
                                  const char* what) const;

    std::int64_t integer(const std::string& object, const char* name) const;  ///< A single one.
    double real(const std::string& object, const char* name) const;           ///< A single one.
    std::string text(const std::string& object, const char* name) const;
    /// Of an attribute, or of a dataset of that name within the object; empty if neither is there.
    std::vector<std::string> texts(const std::string& object, const char* name) const;

    [[noreturn]] void refuse(const std::string& object, std::string_view found, std::string_view expected) const;

    /// A type of number in the file.
    struct Number {
        bool real = false;
        int bytes = 0;
    };
    /// A piece of a dataset's rows, as it is stored.
    struct Chunk {
        std::uint64_t first_row, address, bytes;
        std::uint32_t skipped_filters;
    };
    /// A dataset whose rows lie in pieces that are whole rows; a contiguous one is a single piece.
    struct Dataset {
        std::string name;
        Number number;
        Shape shape;
        std::uint64_t chunk_rows = 0;
        std::vector<int> filters;   ///< In the order in which they were applied.
        std::vector<Chunk> chunks;  ///< By their first rows.
        std::uint64_t stored = 0;   ///< In all chunks [bytes].

        std::uint64_t row_bytes() const;
    };
    /// @param with_chunks  false: nothing will be read; until a writer has committed its first frame, the place of the
    ///                     index of chunks may be half written
    Dataset open(const std::string& name, bool with_chunks) const;
    /// Reads whole rows, which count towards most_expansion unless `counted` is false: what is dropped at once.
    std::vector<double> read_reals(const Dataset& dataset, std::uint64_t first, std::uint64_t rows, bool counted) const;
    /// Returns the chunk that holds a row, or null.
    static const Chunk* chunk_of(const Dataset& dataset, std::uint64_t row);
    std::vector<unsigned char> stored_bytes(const Dataset& dataset, const Chunk& chunk) const;

private:
    struct Attribute;
    template <class Act>
    auto guarded(const std::string& object, const Act& act) const;
    std::vector<Hdf5Message> messages(const std::string& object) const;
    void read_chunks(const ByteView& layout, Dataset& dataset, bool with_chunks) const;
    void read_chunk_nodes(std::uint64_t address, int level, Dataset& dataset, const Shape& chunk) const;
    std::vector<unsigned char> rows_of(const Dataset& dataset, std::uint64_t first, std::uint64_t rows,
                                       bool counted) const;
    Attribute attribute(const std::string& object, const char* name) const;
    Attribute unfiltered_dataset(const std::string& name) const;
    template <class Value>
    Value single(const std::string& object, const char* name) const;
    template <class Value>
    std::vector<Value> read(const std::string& name, const Shape& shape, std::uint64_t rows) const;

    std::string path_;
    Hdf5Objects objects_;
    mutable std::uint64_t bytes_read_ = 0;  ///< Of all arrays and texts so far.
};

}  // namespace selvage
