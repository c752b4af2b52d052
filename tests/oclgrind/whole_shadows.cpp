// Loaded before the simulator, whose record of what was written (Oclgrind 21.10, --uninitialized) is kept per
// buffer and goes wrong in three ways. It outlives the buffer, at the buffer's size, and the next buffer of
// the same number inherits it; a fill shrinks it to one pattern; a write or a copy shrinks it to what is
// written. So here no buffer is ever released, and fills, writes and copies cover the whole buffer. The
// price: where a part is written so, the rest counts as written too, and so does what is copied.
#include <CL/cl.h>
#include <dlfcn.h>

#include <cstring>
#include <vector>

namespace {

template <class Function>
Function* simulated(Function* /*as*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// Repeats the pattern over `size` bytes from `offset` and writes the whole buffer; always waits.
cl_int overwrite(cl_command_queue queue, cl_mem buffer, size_t offset, size_t size, const void* pattern,
                 size_t pattern_size, cl_uint wait_count, const cl_event* waits, cl_event* event) {
  size_t whole = 0;
  if (const cl_int error = clGetMemObjectInfo(buffer, CL_MEM_SIZE, sizeof(whole), &whole, nullptr))
    return error;
  if (offset + size > whole) return CL_INVALID_VALUE;
  std::vector<char> values(whole);
  if (const cl_int error =
          clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, whole, values.data(), wait_count, waits, nullptr))
    return error;
  for (size_t at = 0; at < size; at += pattern_size)
    std::memcpy(values.data() + offset + at, pattern, pattern_size);
  return simulated(&clEnqueueWriteBuffer, "clEnqueueWriteBuffer")(queue, buffer, CL_TRUE, 0, whole,
                                                                  values.data(), 0, nullptr, event);
}

}  // namespace

// The record also errs on shuffles of wide vectors: as of a GPU, kernels are written over single lanes.
extern "C" cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t room, void* value,
                                  size_t* size) {
  const cl_int error = simulated(&clGetDeviceInfo, "clGetDeviceInfo")(device, what, room, value, size);
  if (error == CL_SUCCESS && what == CL_DEVICE_TYPE && value != nullptr)
    *static_cast<cl_device_type*>(value) = CL_DEVICE_TYPE_GPU;
  return error;
}

extern "C" cl_int clReleaseMemObject(cl_mem buffer) {
  cl_uint references = 0;
  if (const cl_int error =
          clGetMemObjectInfo(buffer, CL_MEM_REFERENCE_COUNT, sizeof(references), &references, nullptr))
    return error;
  return references == 1 ? CL_SUCCESS : simulated(&clReleaseMemObject, "clReleaseMemObject")(buffer);
}

extern "C" cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool /*blocking*/,
                                       size_t offset, size_t size, const void* data, cl_uint wait_count,
                                       const cl_event* waits, cl_event* event) {
  return overwrite(queue, buffer, offset, size, data, size, wait_count, waits, event);
}

extern "C" cl_int clEnqueueFillBuffer(cl_command_queue queue, cl_mem buffer, const void* pattern,
                                      size_t pattern_size, size_t offset, size_t size, cl_uint wait_count,
                                      const cl_event* waits, cl_event* event) {
  return overwrite(queue, buffer, offset, size, pattern, pattern_size, wait_count, waits, event);
}

extern "C" cl_int clEnqueueCopyBuffer(cl_command_queue queue, cl_mem from, cl_mem to, size_t from_offset,
                                      size_t to_offset, size_t size, cl_uint wait_count,
                                      const cl_event* waits, cl_event* event) {
  std::vector<char> values(size);
  if (const cl_int error = clEnqueueReadBuffer(queue, from, CL_TRUE, from_offset, size, values.data(),
                                               wait_count, waits, nullptr))
    return error;
  return overwrite(queue, to, to_offset, size, values.data(), size, 0, nullptr, event);
}
