#pragma once
#include <hdf5.h>

namespace selvage {

/// Makes HDF5 write in an order that survives a kill at any moment.
///
/// HDF5 updates a file in place and in no particular order, so that a process killed during a flush can leave
/// an index that points nowhere. Below this driver a file on disk changes as follows:
///   1. bytes beyond the end of the last commit are written at once: nothing on disk refers to them yet;
///   2. changes of older bytes are held in memory until H5Fflush or H5Fclose, which write the superblock (the
///      file has its new length by then), then B-tree nodes from the root down (a parent finds the new half of
///      a split node before the old half loses its entries), then data, then object headers by address;
///   3. within one object only the bytes that differ are written; in a B-tree node first the new entry, then the
///      count that covers it, then the key that leads to it.
/// Each such write is at most some hundred bytes long, and the file is readable before and after each of them.
/// The order holds while space is never freed: open a closed file, then only append.
/// The driver takes no file lock, so that a running file can be read.
///
/// HDF5's own drivers do not do. In validation/unit/io/test_kill.cpp, 70 frames are 2057 changes of the file when they
/// are written by HDF5 1.10 or 1.14 alone; of the files that a kill after one of these leaves, 4 have an index of
/// chunks that leads nowhere, with which all 64 frames so far are lost, 30 lack the last committed frame, and 15 are
/// refused or show a frame that is not whole. Below this driver there are none. HDF5's mode for readers beside a
/// writer (SWMR) keeps an order too, but files of killed writers then only open once a repair tool has cleared them.
/// @throws std::runtime_error if HDF5 refuses the driver.
void use_commit_driver(hid_t file_access_properties);

/// Returns the error number of the last opening of a file below the driver; 0 if the system opened it.
int commit_open_error();

/// Returns the error number of the first write to the file that failed, as on a full disk; 0 if none did.
///
/// HDF5 itself is not told, since it may crash when it closes such a file. From the failure on nothing reaches the
/// disk, where the file stays as it was at the last flush that succeeded.
int commit_error(hid_t file);

}  // namespace selvage
