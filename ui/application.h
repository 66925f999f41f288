// What has to be done once for the whole program before its window is made.
#pragma once

class QApplication;

namespace tessera {

// Names, icon, resources, theme and the number of workers.
void setUpApplication(QApplication& application);

}  // namespace tessera
