# Sets octomap_msgs_INCLUDE_DIRS, and octomap_msgs_TARGET where something is to be generated first: of
# the package in the workspace or installed, else of our own folder of the same messages. What an
# earlier run of ours left in the devel space does not count as installed.
if(TARGET octomap_msgs_generate_messages_cpp)
  set(octomap_msgs_TARGET octomap_msgs_generate_messages_cpp)
else()
  set(own_octomap_msgs ${CATKIN_DEVEL_PREFIX}/share/octomap_msgs/cmake)
  if("${octomap_msgs_DIR}" STREQUAL own_octomap_msgs)
    unset(octomap_msgs_DIR CACHE)
  endif()
  list(APPEND CMAKE_IGNORE_PATH ${own_octomap_msgs})
  find_package(octomap_msgs QUIET)
  if(NOT octomap_msgs_FOUND)
    add_subdirectory(octomap_msgs)
    set(octomap_msgs_TARGET octomap_msgs_generate_messages_cpp)
  endif()
endif()
