// The half of the main window that deals with files: choosing, dropping, and never losing changes unasked.
#include <QCloseEvent>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenu>
#include <QMessageBox>
#include <QMimeData>

#include "app/file_service.h"
#include "ui/dialogs/export_dialog.h"
#include "ui/main_window.h"
#include "ui/message_bar.h"

namespace tessera {

namespace {

// The first local file of what is being dragged; empty where there is none.
QString droppedFile(const QMimeData* data) {
    for (const QUrl& url : data->urls())
        if (url.isLocalFile()) return url.toLocalFile();
    return {};
}

QString withSuffix(const QString& path, const QString& suffix) {
    return QFileInfo(path).suffix().isEmpty() ? path + '.' + suffix : path;
}

}  // namespace

void MainWindow::open(const QString& path) {
    withChangesKept([this, path] { mWorkspace.open(path); });
}

void MainWindow::vectorizeWhenOpen() {
    if (mWorkspace.running(JobKind::Open))
        mVectorizeWhenOpen = true;
    else
        startVectorize();
}

void MainWindow::chooseAndOpen() {
    const QString path = QFileDialog::getOpenFileName(this, tr("Open"), mSettings.folder(), openFilter());
    if (!path.isEmpty()) open(path);
}

void MainWindow::saveTo(const QString& path, std::function<void()> then) {
    mWorkspace.save(path, mSettings.embedPhoto(), std::move(then));
}

void MainWindow::save(std::function<void()> then) {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->hasMesh()) return;
    if (session->path().isEmpty()) return chooseAndSave(std::move(then));
    saveTo(session->path(), std::move(then));
}

void MainWindow::chooseAndSave(std::function<void()> then) {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->hasMesh()) return;
    const QString path = QFileDialog::getSaveFileName(this, tr("Save As"), session->suggestedPath("tessera"),
                                                      tr("Tessera documents (*.tessera)"));
    if (!path.isEmpty()) saveTo(withSuffix(path, "tessera"), std::move(then));
}

void MainWindow::chooseAndExport() {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->hasMesh()) return;
    ExportDialog dialog({session->width(), session->height()}, session->document().source.iccProfile,
                        mSettings, this);
    if (dialog.exec() != QDialog::Accepted) return;
    ExportRequest request = dialog.request();
    const QString suggested = session->suggestedPath(dialog.suffix());
    const QString path = QFileDialog::getSaveFileName(this, tr("Export Picture"), suggested, dialog.filter());
    if (path.isEmpty()) return;
    request.path = withSuffix(path, dialog.suffix());
    mWorkspace.exportPicture(request);
}

void MainWindow::withChangesKept(std::function<void()> then) {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->modified()) return then();
    QMessageBox box(QMessageBox::Question, tr("Unsaved Changes"),
                    tr("“%1” has changes that are not saved.").arg(session->displayName()),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setInformativeText(tr("Without saving, they will be lost."));
    box.setDefaultButton(QMessageBox::Save);
    switch (box.exec()) {
        case QMessageBox::Save:
            return save(std::move(then));
        case QMessageBox::Discard:
            return then();
        default:
            return;
    }
}

void MainWindow::closeEvent(QCloseEvent* event) {
    if (mClosing || !mWorkspace.session() || !mWorkspace.session()->modified()) {
        storeWindow();
        return event->accept();
    }
    event->ignore();
    withChangesKept([this] {
        mClosing = true;
        // Not from here: a window that is being asked to close cannot be closed.
        QMetaObject::invokeMethod(this, &QWidget::close, Qt::QueuedConnection);
    });
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    if (!droppedFile(event->mimeData()).isEmpty()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
    const QString path = droppedFile(event->mimeData());
    if (path.isEmpty()) return;
    event->acceptProposedAction();
    open(path);
}

void MainWindow::fillRecentMenu() {
    mRecent->clear();
    const QStringList files = mSettings.recentFiles();
    for (const QString& path : files) {
        QAction* action = mRecent->addAction(QFileInfo(path).fileName().replace('&', "&&"));
        action->setStatusTip(path);
        connect(action, &QAction::triggered, this, [this, path] { open(path); });
    }
    if (files.isEmpty()) {
        mRecent->addAction(tr("No Recent Files"))->setEnabled(false);
        return;
    }
    mRecent->addSeparator();
    connect(mRecent->addAction(tr("Clear the List")), &QAction::triggered, this,
            [this] { mSettings.clearRecentFiles(); });
}

}  // namespace tessera
