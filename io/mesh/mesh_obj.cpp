#include "io/mesh/mesh_obj.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "io/atomic_file.hpp"
#include "io/errors.hpp"
#include "io/file_text.hpp"
#include "io/mesh/axes.hpp"
#include "io/mesh/length_unit.hpp"
#include "io/mesh/obj_lines.hpp"

namespace selvage {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

// Removes the next word from a line and returns it; empty at the end of the line.
std::string_view take_word(std::string_view& line)
{
    std::size_t begin = 0;
    while (begin < line.size() && is_space(line[begin])) ++begin;
    std::size_t end = begin;
    while (end < line.size() && !is_space(line[end])) ++end;
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::string_view trimmed(std::string_view line)
{
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    return line;
}

std::string quoted(std::string_view text)
{
    constexpr std::size_t limit = 60;
    return "`" + std::string(text.substr(0, limit)) + (text.size() > limit ? "...`" : "`");
}

struct Corner {
    int vertex = 0;
    int texture = -1;  ///< -1: none.
};

class ObjReader {
public:
    explicit ObjReader(const std::string& path) { mesh.path = path; }

    void read(std::string text);

    ObjMesh mesh;

private:
    void read_line(std::string_view line);
    void read_face(std::string_view line);
    void start_part(std::string_view name);
    void finish_parts();
    double read_number(std::string_view& line, const char* meaning) const;
    Corner read_corner(std::string_view word);
    int read_index(std::string_view& word, int count, const char* kind, int& largest, int& largest_line) const;
    [[noreturn]] void refuse(int line, std::string_view found, std::string_view expected) const;

    int line_ = 0;
    int largest_vertex_ = -1, largest_vertex_line_ = 0;
    int largest_texture_ = -1, largest_texture_line_ = 0;
};

void ObjReader::refuse(int line, std::string_view found, std::string_view expected) const
{
    throw InputError({mesh.path, line, 0, {}}, found, expected);
}

void ObjReader::read(std::string text)
{
    ObjLines lines(std::move(text));
    while (lines.next()) {
        line_ = lines.number();
        read_line(lines.line());
    }
    if (mesh.polygon_lines.empty()) refuse(0, "no faces", "an OBJ file with lines `f i j k`");
    mesh.polygon_starts.push_back(int(mesh.corner_vertices.size()));
    const auto check = [&](int largest, int line, std::size_t count, const std::string& kind) {
        if (largest >= int(count))
            refuse(line, "index " + std::to_string(largest + 1) + " of a " + kind,
                   "an index from 1 to " + std::to_string(count));
    };
    check(largest_vertex_, largest_vertex_line_, mesh.vertices.size(), "vertex");
    check(largest_texture_, largest_texture_line_, mesh.texture.size(), "texture coordinate");
    finish_parts();
}

void ObjReader::read_line(std::string_view line)
{
    std::string_view rest = line;
    const std::string_view keyword = take_word(rest);
    if (keyword == "v") {
        const double x = read_number(rest, "x"), y = read_number(rest, "y"), z = read_number(rest, "z");
        mesh.vertices.emplace_back(x, y, z);
        mesh.vertex_lines.push_back(line_);
    } else if (keyword == "vt") {
        const double u = read_number(rest, "u");
        mesh.texture.emplace_back(u, trimmed(rest).empty() ? 0 : read_number(rest, "v"));
    } else if (keyword == "f") {
        read_face(rest);
    } else if (keyword == "o" || keyword == "g") {
        start_part(trimmed(rest));
    }
}

double ObjReader::read_number(std::string_view& line, const char* meaning) const
{
    constexpr double limit = 1e9;
    const std::string_view word = take_word(line);
    std::string_view digits = word;
    if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
    double value = 0;
    const std::from_chars_result end = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool tiny = end.ec == std::errc::result_out_of_range && digits.find_first_of("eE") + 1 == digits.find('-', 1);
    if ((end.ec != std::errc() && !tiny) || end.ptr != digits.data() + digits.size() || !(std::abs(value) <= limit))
        refuse(line_, word.empty() ? "no number" : quoted(word),
               "a finite number for " + std::string(meaning) + ", at most 1e9 in magnitude");
    return value;
}

int ObjReader::read_index(std::string_view& word, int count, const char* kind, int& largest, int& largest_line) const
{
    int index = 0;
    const std::from_chars_result end = std::from_chars(word.data(), word.data() + word.size(), index);
    if (end.ec != std::errc() || index == 0 || index < -count)
        refuse(line_, "index " + quoted(word.substr(0, word.find('/'))) + " of a " + kind,
               "an index from 1 or from -1 to -" + std::to_string(count));
    word.remove_prefix(std::size_t(end.ptr - word.data()));
    index = index > 0 ? index - 1 : count + index;
    // A face may come before its vertices in the file, so the upper bound is checked at the end of the file.
    if (index > largest) {
        largest = index;
        largest_line = line_;
    }
    return index;
}

Corner ObjReader::read_corner(std::string_view word)
{
    const std::string_view whole = word;
    Corner corner;
    corner.vertex = read_index(word, int(mesh.vertices.size()), "vertex", largest_vertex_, largest_vertex_line_);
    if (!word.empty() && word.front() == '/') {
        word.remove_prefix(1);
        if (!word.empty() && word.front() != '/')
            corner.texture = read_index(word, int(mesh.texture.size()), "texture coordinate", largest_texture_,
                                        largest_texture_line_);
        // The index of a normal follows; normals are not read.
        if (!word.empty() && word.front() == '/')
            word.remove_prefix(std::min(word.find_first_not_of("-0123456789", 1), word.size()));
    }
    if (!word.empty()) refuse(line_, quoted(whole), "a corner as i, i/t, i//n or i/t/n");
    return corner;
}

void ObjReader::read_face(std::string_view line)
{
    const std::size_t first = mesh.corner_vertices.size();
    for (std::string_view word = take_word(line); !word.empty() && word.front() != '#'; word = take_word(line)) {
        const Corner corner = read_corner(word);
        if (corner.texture >= 0 && mesh.corner_textures.empty())
            mesh.corner_textures.resize(mesh.corner_vertices.size(), -1);
        if (corner.texture >= 0 || !mesh.corner_textures.empty()) mesh.corner_textures.push_back(corner.texture);
        mesh.corner_vertices.push_back(corner.vertex);
    }
    const std::size_t count = mesh.corner_vertices.size() - first;
    if (count < 3) refuse(line_, "a face with " + std::to_string(count) + " vertices", "at least 3 vertices");
    mesh.polygon_starts.push_back(int(first));
    mesh.polygon_lines.push_back(line_);
}

void ObjReader::start_part(std::string_view name)
{
    const int polygon = mesh.polygon_count();
    if (mesh.parts.empty() && polygon > 0) mesh.parts.push_back({"", 0, 0});
    if (!mesh.parts.empty() && mesh.parts.back().first_face == polygon) mesh.parts.pop_back();
    mesh.parts.push_back({std::string(name), polygon, 0});
}

void ObjReader::finish_parts()
{
    const int count = mesh.polygon_count();
    if (!mesh.parts.empty() && mesh.parts.back().first_face == count) mesh.parts.pop_back();
    for (std::size_t part = 0; part < mesh.parts.size(); ++part) {
        const int end = part + 1 < mesh.parts.size() ? mesh.parts[part + 1].first_face : count;
        mesh.parts[part].face_count = end - mesh.parts[part].first_face;
    }
}

// Compares texts so that runs of digits count as numbers: 2 before 10.
bool naturally_before(std::string_view a, std::string_view b)
{
    const auto take_digits = [](std::string_view& text) {
        std::size_t count = 0;
        while (count < text.size() && text[count] >= '0' && text[count] <= '9') ++count;
        std::string_view digits = text.substr(0, count);
        text.remove_prefix(count);
        while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
        return digits;
    };
    const std::string_view whole_a = a, whole_b = b;
    while (!a.empty() && !b.empty()) {
        const std::string_view m = take_digits(a), n = take_digits(b);
        if (m.empty() || n.empty()) {
            if (m != n) return !m.empty();
            if (a.front() != b.front()) return a.front() < b.front();
            a.remove_prefix(1);
            b.remove_prefix(1);
        } else if (m != n) {
            return m.size() != n.size() ? m.size() < n.size() : m < n;
        }
    }
    if (a.empty() != b.empty()) return a.empty();
    return whole_a < whole_b;
}

// The number that a whole text is, or -1.
long long number_of(std::string_view text)
{
    long long number = -1;
    const std::from_chars_result end = std::from_chars(text.data(), text.data() + text.size(), number);
    return end.ec == std::errc() && end.ptr == text.data() + text.size() && number >= 0 ? number : -1;
}

void append_numbers(std::string& text, const char* keyword, const double* values, int count)
{
    text += keyword;
    char digits[32];
    for (int k = 0; k < count; ++k) {
        const std::to_chars_result end =
            std::to_chars(digits, digits + sizeof digits, values[k], std::chars_format::general, 9);
        text += ' ';
        text.append(digits, end.ptr);
    }
    text += '\n';
}

// A name that cannot end its line or, by a backslash, go on in the next one.
std::string one_line(std::string name)
{
    for (char& c : name)
        if ((c >= 0 && c < ' ') || c == '\x7f') c = '_';
    if (name.ends_with('\\')) name.back() = '_';
    return name;
}

}  // namespace

std::vector<SequenceFile> sequence_files(const std::string& pattern, const InputPlace& place)
{
    namespace fs = std::filesystem;
    const fs::path whole(pattern);
    const std::string name = whole.filename().string();
    const std::size_t star = name.find('*');
    if (star == std::string::npos || name.find('*', star + 1) != std::string::npos)
        throw InputError(place, "`" + pattern + "`", "a file name with one *, such as pose_*.obj");
    const std::string head = name.substr(0, star), tail = name.substr(star + 1);
    std::vector<SequenceFile> files;
    std::error_code error;
    for (const auto& entry :
         fs::directory_iterator(whole.has_parent_path() ? whole.parent_path() : fs::path("."), error)) {
        const std::string found = entry.path().filename().string();
        if (found.size() + 1 >= name.size() && found.starts_with(head) && found.ends_with(tail))
            files.push_back({entry.path().string(),
                             number_of(std::string_view(found).substr(star, found.size() + 1 - name.size()))});
    }
    if (files.empty()) throw InputError(place, "`" + pattern + "`, no such files", "OBJ files of a body's poses");
    std::sort(files.begin(), files.end(), [](const SequenceFile& a, const SequenceFile& b) {
        if (a.number != b.number && a.number >= 0 && b.number >= 0) return a.number < b.number;
        if ((a.number < 0) != (b.number < 0)) return a.number >= 0;
        return naturally_before(a.path, b.path);
    });
    for (std::size_t k = 1; k < files.size(); ++k)
        if (files[k].number >= 0 && files[k].number == files[k - 1].number)
            throw InputError(place,
                             "`" + files[k - 1].path + "` and `" + files[k].path + "`, which have the same number",
                             "one file for each pose");
    return files;
}

ObjMesh read_obj(const std::string& path, LengthUnit unit, Axis up_axis)
{
    const double scale = metres_per(unit);
    const Mat3 turn = scale * z_up_from(up_axis);
    ObjReader reader(path);
    reader.read(read_file_text(path, "an OBJ file"));
    for (Vec3& vertex : reader.mesh.vertices) vertex = turn * vertex;
    return std::move(reader.mesh);
}

void write_obj(const std::string& path, std::span<const ObjObject> objects)
{
    std::string text;
    std::vector<int> numbers;  // of all positions so far, from 1
    int offset = 1, written = 0;
    for (const ObjObject& object : objects) {
        text += "o " + one_line(object.name) + "\n";
        for (std::size_t k = 0; k < object.positions.size(); ++k) {
            const int repeated = object.repeated.empty() ? -1 : object.repeated[k];
            if (repeated < 0) append_numbers(text, "v", object.positions[k].data(), 3);
            numbers.push_back(repeated < 0 ? ++written : numbers[std::size_t(repeated)]);
        }
        for (const Vec2& point : object.texture) append_numbers(text, "vt", point.data(), 2);
        for (const Face& face : object.faces) {
            text += 'f';
            for (const int corner : face) {
                text += ' ' + std::to_string(numbers[std::size_t(corner + offset - 1)]);
                if (!object.texture.empty()) text += '/' + std::to_string(corner + offset);
            }
            text += '\n';
        }
        offset += int(object.positions.size());
    }
    write_file_atomically(path, text);
}

}  // namespace selvage
