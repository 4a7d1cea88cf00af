# Writes a C++ file that holds every file below FOLDER that matches PATTERN, as the body of a function that HEADER
# declares (see io/scene/presets.hpp):
#     cmake -DFOLDER=io/presets -DPATTERN=*.toml -DHEADER=io/scene/presets.hpp -DFUNCTION=preset_files
#           -DOUTPUT=preset_files.cpp -P io/embed_presets.cmake
cmake_minimum_required(VERSION 3.20)

foreach(argument FOLDER PATTERN HEADER FUNCTION OUTPUT)
    if(NOT ${argument})
        message(FATAL_ERROR "${argument} must be given")
    endif()
endforeach()

# The C++ standard asks compilers for no more than this in one string literal.
set(literal_limit 65536)
set(entries "")
file(GLOB_RECURSE paths LIST_DIRECTORIES false RELATIVE "${FOLDER}" "${FOLDER}/${PATTERN}")
list(SORT paths)
foreach(path IN LISTS paths)
    file(SIZE "${FOLDER}/${path}" size)
    if(NOT size LESS literal_limit)
        message(FATAL_ERROR "${FOLDER}/${path} has ${size} bytes, a built-in file must be below ${literal_limit}")
    endif()
    file(READ "${FOLDER}/${path}" text)
    string(APPEND entries "    {\"${path}\", R\"preset(${text})preset\"},\n")
endforeach()

file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [=[
#include "@HEADER@"

namespace selvage {
namespace {

constexpr PresetFile files[] = {
@entries@};

}  // namespace

std::span<const PresetFile> @FUNCTION@()
{
    return files;
}

}  // namespace selvage
]=])
