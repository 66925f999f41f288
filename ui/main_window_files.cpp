// The part of the main window that deals with files: choosing, dropping, and never losing changes unasked.
#include <QClipboard>
#include <QCloseEvent>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QGuiApplication>
#include <QMenu>
#include <QMessageBox>
#include <QPushButton>

#include "app/file_service.h"
#include "ui/canvas_widget.h"
#include "ui/conversions.h"
#include "ui/dialogs/export_dialog.h"
#include "ui/dialogs/save_path.h"
#include "ui/main_window.h"
#include "ui/message_bar.h"
#include "ui/start_page.h"

namespace tessera {

void MainWindow::open(const QString& path) {
    mWorkspace.open(path);
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

void MainWindow::saveTo(const QString& path) {
    mWorkspace.save(path, mSettings.embedPhoto());
}

void MainWindow::save() {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->hasMesh()) return;
    session->path().isEmpty() ? chooseAndSave() : saveTo(session->path());
}

void MainWindow::chooseAndSave() {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->hasMesh()) return;
    const QString path = askForPath(*session);
    if (!path.isEmpty()) saveTo(path);
}

QString MainWindow::askForPath(const DocumentSession& session) {
    return askForSavePath(this, tr("Save As"), mSettings.outsideCache(session.suggestedPath("tessera")),
                          tr("Tessera documents (*.tessera)"));
}

void MainWindow::chooseAndExport() {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->hasMesh()) return;
    ExportDialog dialog({session->width(), session->height()}, session->document().source.iccProfile,
                        mSettings, this);
    if (dialog.exec() != QDialog::Accepted) return;
    ExportRequest request = dialog.request();
    request.path =
        askForSavePath(this, tr("Export Picture"),
                       mSettings.outsideCache(session->suggestedPath(dialog.suffix())), dialog.filter());
    if (request.path.isEmpty()) return;
    mSettings.setFolder(QFileInfo(request.path).absolutePath());
    mWorkspace.exportPicture(request);
}

void MainWindow::chooseAndRelink() {
    const QString path =
        QFileDialog::getOpenFileName(this, tr("Find the Photo"), mSettings.folder(), openFilter());
    if (!path.isEmpty()) mWorkspace.relinkPhoto(path);
}

void MainWindow::paste() {
    const QImage picture = QGuiApplication::clipboard()->image();
    if (picture.isNull()) return say(tr("There is no picture in the clipboard."));
    mWorkspace.paste(picture);
}

void MainWindow::copy() {
    const DocumentSession* session = mWorkspace.session();
    if (!session || !session->hasMesh()) return;
    const QString done = session->selection().patches().empty()
                             ? tr("The picture is in the clipboard.")
                             : tr("The selected patches are in the clipboard.");
    mWorkspace.drawSelection([this, done](const QImage& picture) {
        QGuiApplication::clipboard()->setImage(picture);
        say(done);
    });
}

void MainWindow::closeSession(DocumentSession* session) {
    if (session) return mWorkspace.close(session, closeQuestions());
    // The start page, which is no document.
    if (!mWorkspace.sessions().isEmpty()) mWorkspace.setCurrent(mWorkspace.sessions().last());
}

CloseQuestions MainWindow::closeQuestions() {
    return {.unsaved = [this](DocumentSession& session) { return askAboutChanges(session); },
            .running = [this](const QStringList& titles) { return askAboutWork(titles); }};
}

RunningAnswer MainWindow::askAboutWork(const QStringList& titles) {
    QMessageBox box(QMessageBox::Question, tr("Still Running"),
                    tr("This is still running: %1.").arg(titles.join(", ")), {}, this);
    box.setInformativeText(tr("What is stopped is lost."));
    auto* wait = box.addButton(tr("&Wait, Then Close"), QMessageBox::AcceptRole);
    wait->setObjectName("wait");
    auto* stop = box.addButton(tr("&Stop and Close"), QMessageBox::DestructiveRole);
    stop->setObjectName("stop");
    box.addButton(QMessageBox::Cancel);
    box.setDefaultButton(wait);
    box.exec();
    if (box.clickedButton() == wait) return RunningAnswer::Wait;
    return box.clickedButton() == stop ? RunningAnswer::Stop : RunningAnswer::Cancel;
}

CloseAnswer MainWindow::askAboutChanges(DocumentSession& session) {
    QMessageBox box(QMessageBox::Question, tr("Unsaved Changes"),
                    tr("“%1” has changes that are not saved.").arg(session.displayName()),
                    QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
    box.setInformativeText(tr("Without saving, they will be lost."));
    box.setDefaultButton(QMessageBox::Save);
    CloseAnswer answer{.embedPhoto = mSettings.embedPhoto()};
    switch (box.exec()) {
        case QMessageBox::Save:
            answer.path = session.path();
            if (answer.path.isEmpty()) answer.path = askForPath(session);
            if (!answer.path.isEmpty()) answer.kind = CloseAnswer::Kind::Save;
            break;
        case QMessageBox::Discard:
            answer.kind = CloseAnswer::Kind::Discard;
            break;
        default:
            break;
    }
    return answer;
}

void MainWindow::closeEvent(QCloseEvent* event) {
    // What a field or a slider waits with is a change too.
    mCanvas->setFocus();
    if (mClosing || (mWorkspace.sessions().isEmpty() && !mWorkspace.currentJob())) {
        storeWindow();
        return event->accept();
    }
    event->ignore();
    mWorkspace.closeAll(closeQuestions(), [this](bool closed) {
        if (!closed) return;
        mClosing = true;
        // Not from here: a window that is being asked to close cannot be closed.
        QMetaObject::invokeMethod(this, &QWidget::close, Qt::QueuedConnection);
    });
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    if (!localFiles(event->mimeData()).isEmpty()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
    const QStringList paths = localFiles(event->mimeData());
    if (paths.isEmpty()) return;
    event->acceptProposedAction();
    for (const QString& path : paths) open(path);
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
    connect(mRecent->addAction(tr("Clear the List")), &QAction::triggered, this, [this] {
        mSettings.clearRecentFiles();
        mStart->setRecentFiles({});
    });
}

}  // namespace tessera
